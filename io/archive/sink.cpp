// HDF5 1.10 cannot close a file that it fails to write: when the disk is full, H5Fclose fails, the
// file stays open inside the library with its dirty cache, and the library loops or crashes when the
// process ends. One full disk would take all models of a run with it. So we write through a file
// driver of our own, whose writes always seem to succeed; its errors are looked up after each step
// instead. The file is closed in the normal way, and then removed.
//
// After an error HDF5 may read back what was thrown away. Metadata of our files fit into its cache,
// so that does not happen on the way to a clean close.

#include "io/archive/sink.h"

#include <fcntl.h>
#include <sys/types.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <new>
#include <system_error>

namespace lumenline::hdf {

namespace {

/// What the access property list carries.
struct Info {
    Sink::State* state;
};

/// The driver's file; HDF5 sees its first member. The descriptor belongs to the sink.
struct File {
    H5FD_t common{};
    Sink::State* state = nullptr;
    haddr_t allocated = 0;
    haddr_t end = 0;
};

File* own(H5FD_t* file) { return reinterpret_cast<File*>(file); }
const File* own(const H5FD_t* file) { return reinterpret_cast<const File*>(file); }

H5FD_t* open_file(const char* /*name*/, unsigned /*flags*/, hid_t access, haddr_t /*largest*/) {
    const auto* info = static_cast<const Info*>(H5Pget_driver_info(access));
    if (info == nullptr) return nullptr;
    auto* file = new (std::nothrow) File;
    if (file == nullptr) return nullptr;
    file->state = info->state;
    return &file->common;
}

herr_t close_file(H5FD_t* file) {
    delete own(file);
    return 0;
}

int compare(const H5FD_t* a, const H5FD_t* b) { return own(a)->state->descriptor - own(b)->state->descriptor; }

herr_t query(const H5FD_t* /*file*/, unsigned long* flags) {
    *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
             H5FD_FEAT_AGGREGATE_SMALLDATA | H5FD_FEAT_DEFAULT_VFD_COMPATIBLE;
    return 0;
}

haddr_t allocated_end(const H5FD_t* file, H5FD_mem_t /*type*/) { return own(file)->allocated; }

herr_t set_allocated_end(H5FD_t* file, H5FD_mem_t /*type*/, haddr_t address) {
    own(file)->allocated = address;
    return 0;
}

haddr_t end_of_file(const H5FD_t* file, H5FD_mem_t /*type*/) { return own(file)->end; }

herr_t read_bytes(H5FD_t* file, H5FD_mem_t /*type*/, hid_t /*transfer*/, haddr_t address, std::size_t size,
                  void* buffer) {
    auto* target = static_cast<char*>(buffer);
    while (size > 0) {
        const ssize_t got = ::pread(own(file)->state->descriptor, target, size, static_cast<off_t>(address));
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) break;
        target += got;
        address += static_cast<haddr_t>(got);
        size -= static_cast<std::size_t>(got);
    }
    std::memset(target, 0, size);  // what was never written
    return 0;
}

herr_t write_bytes(H5FD_t* file, H5FD_mem_t /*type*/, hid_t /*transfer*/, haddr_t address, std::size_t size,
                   const void* buffer) {
    Sink::State& state = *own(file)->state;
    const auto* source = static_cast<const char*>(buffer);
    own(file)->end = std::max(own(file)->end, address + size);
    while (size > 0 && state.error == 0) {
        const ssize_t put = ::pwrite(state.descriptor, source, size, static_cast<off_t>(address));
        if (put < 0) {
            if (errno != EINTR) state.error = errno;
            continue;
        }
        source += put;
        address += static_cast<haddr_t>(put);
        size -= static_cast<std::size_t>(put);
    }
    return 0;
}

herr_t truncate_file(H5FD_t* file, hid_t /*transfer*/, hbool_t /*closing*/) {
    Sink::State& state = *own(file)->state;
    if (state.error == 0 && ::ftruncate(state.descriptor, static_cast<off_t>(own(file)->allocated)) != 0)
        state.error = errno;
    own(file)->end = own(file)->allocated;
    return 0;
}

H5FD_class_t driver_class() {
    H5FD_class_t driver{};
    driver.name = "lumenline";
    driver.maxaddr = (haddr_t{1} << (8 * sizeof(off_t) - 1)) - 1;
    driver.fc_degree = H5F_CLOSE_SEMI;
    driver.fapl_size = sizeof(Info);
    driver.open = open_file;
    driver.close = close_file;
    driver.cmp = compare;
    driver.query = query;
    driver.get_eoa = allocated_end;
    driver.set_eoa = set_allocated_end;
    driver.get_eof = end_of_file;
    driver.read = read_bytes;
    driver.write = write_bytes;
    driver.truncate = truncate_file;
    constexpr H5FD_mem_t kMap[H5FD_MEM_NTYPES] = H5FD_FLMAP_DICHOTOMY;
    std::copy(std::begin(kMap), std::end(kMap), std::begin(driver.fl_map));
    return driver;
}

}  // namespace

Sink::Sink(const std::filesystem::path& file) : file_(file) {
    state_.descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (state_.descriptor < 0)
        throw std::system_error(errno, std::generic_category(), "cannot create '" + file.string() + "'");
    const H5FD_class_t driver = driver_class();
    driver_ = Handle(H5FDregister(&driver), H5FDunregister, "file driver");
}

Sink::~Sink() {
    if (state_.descriptor >= 0) ::close(state_.descriptor);
}

Handle Sink::access() {
    Handle access = file_access();
    const Info info{&state_};
    checked(H5Pset_driver(access.get(), driver_.get(), &info), "file driver");
    return access;
}

void Sink::require_good() const {
    if (state_.error != 0)
        throw std::system_error(state_.error, std::generic_category(), "cannot write '" + file_.string() + "'");
}

void Sink::discard() {
    if (state_.error == 0) state_.error = ECANCELED;
}

}  // namespace lumenline::hdf
