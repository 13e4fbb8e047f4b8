// As root, without systemd, cgroups or a database: processes are followed by proctrack/linuxproc. Credentials expire
// within seconds, since Slurm holds a requeued job back for as long as one is valid.
#include "tests/slurm/local_cluster.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <signal.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <stdexcept>
#include <thread>

namespace lumenline::cli_test {

namespace fs = std::filesystem;

namespace {

constexpr std::array<const char*, 3> kDaemons{"munged", "slurmctld", "slurmd"};

/// Path of a program, also where PATH has no sbin; empty if there is none.
fs::path find_program(const std::string& name) {
    for (const char* folder : {"/usr/sbin", "/usr/bin", "/usr/local/sbin", "/usr/local/bin", "/sbin", "/bin"})
        if (const fs::path program = fs::path(folder) / name; ::access(program.c_str(), X_OK) == 0) return program;
    return {};
}

std::string host_name() {
    std::array<char, 256> host{};
    if (::gethostname(host.data(), host.size() - 1) != 0) throw std::runtime_error("this machine has no name");
    const std::string name = host.data();
    return name.substr(0, name.find('.'));
}

/// A port of loopback that nobody has.
int free_port() {
    const int descriptor = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t length = sizeof address;
    auto* const any = reinterpret_cast<sockaddr*>(&address);
    const bool known = ::bind(descriptor, any, length) == 0 && ::getsockname(descriptor, any, &length) == 0;
    ::close(descriptor);
    if (!known) throw std::runtime_error("no port is free");
    return ntohs(address.sin_port);
}

/// slurmstepd puts sockets into its folder, whose paths may have no more than 107 letters.
fs::path short_folder() {
    std::string pattern = "/tmp/lumenline-slurm-XXXXXX";
    if (::mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("cannot make a folder in /tmp");
    return pattern;
}

std::string configuration(const fs::path& folder) {
    const std::string at = folder.string() + "/", host = host_name();
    return "ClusterName=lumenline\nSlurmctldHost=" + host +
           "(127.0.0.1)\nSlurmctldPort=" + std::to_string(free_port()) + "\nSlurmdPort=" + std::to_string(free_port()) +
           "\nAuthType=auth/munge\nAuthInfo=socket=" + at + "munge.socket,cred_expire=5" +
           "\nSlurmUser=root\nSlurmdUser=root\nStateSaveLocation=" + at + "state\nSlurmdSpoolDir=" + at +
           "spool\nSlurmctldPidFile=" + at + "slurmctld.pid\nSlurmdPidFile=" + at + "slurmd.pid" +
           "\nProctrackType=proctrack/linuxproc\nTaskPlugin=task/none\nSelectType=select/cons_tres"
           "\nSelectTypeParameters=CR_CPU\nSwitchType=switch/none\nMpiDefault=none"
           "\nJobAcctGatherType=jobacct_gather/none\nAccountingStorageType=accounting_storage/none"
           "\nMaxArraySize=5\nReturnToService=2\nKillWait=5\nSlurmdParameters=config_overrides"
           "\nSchedulerParameters=sched_interval=2,batch_sched_delay=0,bf_interval=2"
           "\nNodeName=" +
           host + " NodeAddr=127.0.0.1 CPUs=3 State=UNKNOWN\nPartitionName=main Nodes=ALL Default=YES State=UP\n";
}

}  // namespace

std::string LocalCluster::reason_against() {
    if (::geteuid() != 0) return "Slurm's daemons have to be started by root here";
    for (const char* program : kDaemons)
        if (find_program(program).empty())
            return std::string("there is no ") + program + ": install the packages slurm-wlm and munge";
    return "";
}

LocalCluster::LocalCluster() : folder_(short_folder()) {
    const fs::path& folder = folder_;
    fs::create_directories(folder / "state");
    fs::create_directories(folder / "spool");
    write_text(folder / "slurm.conf", configuration(folder));
    write_text(folder / "munge.key", std::string(1024, 'k'));
    fs::permissions(folder / "munge.key", fs::perms::owner_read | fs::perms::owner_write);
    ::setenv("SLURM_CONF", (folder / "slurm.conf").c_str(), 1);
    const auto start = [&](const char* program, std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), find_program(program).string());
        daemons_.push_back(std::make_unique<Process>(arguments, folder));
    };
    const auto file = [&](const char* option, const char* name) { return option + (folder / name).string(); };
    start("munged",
          {"--foreground", "--force", file("--socket=", "munge.socket"), file("--key-file=", "munge.key"),
           file("--pid-file=", "munged.pid"), file("--log-file=", "munged.log"), file("--seed-file=", "munged.seed")});
    while (daemons_.front()->running() && !fs::exists(folder / "munge.socket"))
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    start("slurmctld", {"-D"});
    start("slurmd", {"-D", "-N", host_name()});
}

LocalCluster::~LocalCluster() {
    run_shell("scancel --quiet --user=root", folder_);
    for (auto daemon = daemons_.rbegin(); daemon != daemons_.rend(); ++daemon) {
        (*daemon)->send(SIGTERM);
        (*daemon)->wait();
    }
    ::unsetenv("SLURM_CONF");
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
}

bool LocalCluster::busy() const {
    const std::string queue = run_shell("squeue --noheader --array --format '%i %T %r'", folder_).out;
    if (queue.find("held") != std::string::npos) throw std::runtime_error("jobs cannot be started:\n" + queue);
    return !queue.empty();
}

std::string LocalCluster::wait_until_ready() {
    for (;;) {
        for (const auto& daemon : daemons_)
            if (!daemon->running()) return daemon->wait().err;
        if (run_shell("sinfo --noheader --format %t", folder_).out == "idle\n") return "";
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
}

}  // namespace lumenline::cli_test
