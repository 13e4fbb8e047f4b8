// A lease is made, judged and taken over under a lock (flock) on the file `runs/guard`, which is held for
// milliseconds and vanishes with its process; so of two runs that find the same dead lease one alone takes it. The
// lease itself is a file rather than a lock, because a lock cannot say who holds it, nor be seen from another
// machine on every file system.
//
// A process number alone does not tell a process: it is used again, and means another process in another container
// or after a reboot. So the lease also holds the boot, the process-number namespace, and when the process started.

#include "io/archive/lease.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>
#include <system_error>
#include <utility>

namespace lumenline {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const std::string& action, const fs::path& path) {
    throw std::system_error(errno, std::generic_category(), action + " '" + path.string() + "'");
}

/// An open file.
class Descriptor {
public:
    Descriptor(const fs::path& path, int flags) : id_(::open(path.c_str(), flags | O_CLOEXEC, 0666)) {}
    ~Descriptor() {
        if (id_ >= 0) ::close(id_);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    [[nodiscard]] int get() const { return id_; }
    int take() { return std::exchange(id_, -1); }

private:
    int id_;
};

std::string first_line(const fs::path& path) {
    std::ifstream in(path);
    std::string line;
    std::getline(in, line);
    return line;
}

std::string link_text(const fs::path& path) {
    std::error_code ignored;
    return fs::read_symlink(path, ignored).string();
}

std::string host_name() {
    std::array<char, 256> host{};
    return ::gethostname(host.data(), host.size() - 1) == 0 ? host.data() : "";
}

/// When a process started, in ticks since boot: the 22nd field of /proc/<pid>/stat, counted behind the
/// parenthesis that ends its name. Empty if there is no such process, or it has ended and nobody has asked how.
std::string start_of(long process) {
    const std::string line = first_line("/proc/" + std::to_string(process) + "/stat");
    const std::size_t name_end = line.rfind(')');
    if (name_end == std::string::npos) return "";
    std::istringstream fields(line.substr(name_end + 1));
    constexpr int kFieldsToStart = 19;
    std::string state, field;
    fields >> state;
    for (int i = 0; i < kFieldsToStart; ++i) fields >> field;
    return state == "Z" || state == "X" ? "" : field;
}

using Facts = std::map<std::string, std::string>;

/// What a process of this machine is told by.
Facts machine() {
    return {{"boot", first_line("/proc/sys/kernel/random/boot_id")}, {"processes", link_text("/proc/self/ns/pid")}};
}

std::string own_text() {
    const std::time_t now = std::time(nullptr);
    std::tm utc{};
    gmtime_r(&now, &utc);
    std::array<char, 40> since{};
    std::strftime(since.data(), since.size(), "%Y-%m-%d %H:%M:%S UTC", &utc);
    const long process = ::getpid();
    std::string text = "host=" + host_name() + "\nprocess=" + std::to_string(process) + "\nstart=" + start_of(process) +
                       "\nsince=" + since.data() + "\n";
    for (const auto& [name, value] : machine()) text.append(name).append("=").append(value).append("\n");
    return text;
}

Facts read_facts(const fs::path& file) {
    Facts facts;
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);)
        if (const std::size_t equals = line.find('='); equals != std::string::npos)
            facts[line.substr(0, equals)] = line.substr(equals + 1);
    return facts;
}

fs::path lease_folder(const fs::path& archive_dir) { return archive_dir / "runs"; }

std::string lease_name(Shard shard) {
    return std::to_string(shard.index) + "-of-" + std::to_string(shard.count) + ".lease";
}

std::optional<Shard> shard_of(const std::string& name) {
    Shard shard;
    const char* const end = name.data() + name.size();
    const auto index = std::from_chars(name.data(), end, shard.index);
    const std::size_t middle = static_cast<std::size_t>(index.ptr - name.data());
    if (index.ec != std::errc() || name.compare(middle, 4, "-of-") != 0) return std::nullopt;
    if (std::from_chars(name.data() + middle + 4, end, shard.count).ec != std::errc()) return std::nullopt;
    return lease_name(shard) == name ? std::optional(shard) : std::nullopt;
}

double seconds_of(const timespec& time) {
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Now, by the clock that stamps the files of `folder`; by this machine's where nothing can be written there.
double file_system_now(const fs::path& folder) {
    const Descriptor file(folder / "clock", O_WRONLY | O_CREAT);
    struct stat status {};
    const bool known = file.get() >= 0 && ::futimens(file.get(), nullptr) == 0 && ::fstat(file.get(), &status) == 0;
    return known ? seconds_of(status.st_mtim) : static_cast<double>(std::time(nullptr));
}

std::optional<LeaseHolder> read_lease(const fs::path& file, double now) {
    const std::optional<Shard> shard = shard_of(file.filename().string());
    struct stat status {};
    if (!shard || ::stat(file.c_str(), &status) != 0) return std::nullopt;
    Facts facts = read_facts(file);
    LeaseHolder holder{*shard, facts["host"], std::atol(facts["process"].c_str()), facts["since"], 0, true};
    holder.heartbeat_age = std::max(0.0, now - seconds_of(status.st_mtim));
    bool is_here = !facts["start"].empty();
    for (const auto& [name, value] : machine()) is_here = is_here && !value.empty() && facts[name] == value;
    holder.alive = is_here ? start_of(holder.process) == facts["start"] : holder.heartbeat_age < kLeaseExpirySeconds;
    return holder;
}

std::string part_text(Shard shard) {
    return shard.count == 1 ? "the archive"
                            : "shard " + std::to_string(shard.index) + "/" + std::to_string(shard.count);
}

std::string holder_text(const LeaseHolder& holder) {
    return "process " + std::to_string(holder.process) + " on " + (holder.host.empty() ? "?" : holder.host) +
           " since " + (holder.since.empty() ? "?" : holder.since);
}

}  // namespace

std::vector<LeaseHolder> read_leases(const fs::path& archive_dir) {
    std::vector<LeaseHolder> holders;
    std::error_code none;
    const fs::path folder = lease_folder(archive_dir);
    std::optional<double> now;
    for (const auto& entry : fs::directory_iterator(folder, none)) {
        if (!shard_of(entry.path().filename().string())) continue;
        if (!now) now = file_system_now(folder);
        if (auto holder = read_lease(entry.path(), *now)) holders.push_back(std::move(*holder));
    }
    std::sort(holders.begin(), holders.end(), [](const LeaseHolder& a, const LeaseHolder& b) {
        return std::pair(a.shard.count, a.shard.index) < std::pair(b.shard.count, b.shard.index);
    });
    return holders;
}

Lease::Lease(const fs::path& archive_dir, Shard shard) : file_(lease_folder(archive_dir) / lease_name(shard)) {
    fs::create_directories(lease_folder(archive_dir));
    const fs::path guard_file = lease_folder(archive_dir) / "guard";
    const Descriptor guard(guard_file, O_RDWR | O_CREAT);
    if (guard.get() < 0) refuse("cannot create", guard_file);
    // Where a file system has no locks, the link below still lets one run alone through.
    while (::flock(guard.get(), LOCK_EX) != 0 && errno == EINTR) {
    }
    for (const LeaseHolder& holder : read_leases(archive_dir)) {
        if (holder.shard != shard && holder.shard.count == shard.count) continue;
        if (holder.alive)
            throw LeaseHeld("another run holds " + part_text(holder.shard) + " '" + archive_dir.string() +
                            "': " + holder_text(holder) + "; wait for its end, or stop it");
        taken_over_ =
            "the lease of " + holder_text(holder) + " has expired: that run is dead, and its models are taken over";
        ::unlink((lease_folder(archive_dir) / lease_name(holder.shard)).c_str());
    }
    // Written under another name and then linked: whoever is killed in between leaves no lease that names nobody.
    fs::path draft = file_;
    draft += ".new";
    Descriptor made(draft, O_RDWR | O_CREAT | O_TRUNC);
    if (made.get() < 0) refuse("cannot create", draft);
    const std::string text = own_text();
    if (::write(made.get(), text.data(), text.size()) != static_cast<ssize_t>(text.size()))
        refuse("cannot write", draft);
    const bool linked = ::link(draft.c_str(), file_.c_str()) == 0;
    if (!linked && errno == EEXIST) throw LeaseHeld("another run has just started on " + part_text(shard));
    if (linked)
        ::unlink(draft.c_str());
    else if (::rename(draft.c_str(), file_.c_str()) != 0)  // a file system without links
        refuse("cannot create", file_);
    descriptor_ = made.take();
}

bool Lease::beat() {
    struct stat own {
    }, standing{};
    if (descriptor_ < 0) return false;
    if (::fstat(descriptor_, &own) != 0) return errno != ESTALE;
    if (::stat(file_.c_str(), &standing) != 0) return errno != ENOENT && errno != ESTALE;
    if (own.st_ino != standing.st_ino || own.st_dev != standing.st_dev) return false;
    ::futimens(descriptor_, nullptr);
    return true;
}

void Lease::release() {
    if (descriptor_ < 0) return;
    if (beat()) ::unlink(file_.c_str());
    ::close(std::exchange(descriptor_, -1));
}

Lease::~Lease() { release(); }

}  // namespace lumenline
