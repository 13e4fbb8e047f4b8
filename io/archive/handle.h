#pragma once

#include <hdf5.h>

#include <stdexcept>
#include <string>
#include <utility>

/// RAII over the HDF5 C API. For the sources of io/archive and their tests only.
namespace lumenline::hdf {

/// A call of HDF5 that failed: what was tried, and HDF5's innermost message.
class Error : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Data that contradict themselves: nothing is wrong with the file, but with what should go into it.
class Inconsistent : public Error {
public:
    using Error::Error;
};

/// While it lives, HDF5 prints nothing to standard error; `Error` carries its messages instead.
class Quiet {
public:
    Quiet();
    ~Quiet();
    Quiet(const Quiet&) = delete;
    Quiet& operator=(const Quiet&) = delete;

private:
    H5E_auto2_t function_ = nullptr;
    void* data_ = nullptr;
};

/// Throws Error "`what`: innermost message of HDF5's error stack".
[[noreturn]] void fail(const std::string& what);

/// `result` of a call of HDF5, which is negative if the call failed.
/// @throws Error
template <class Result>
Result checked(Result result, const std::string& what) {
    if (result < 0) fail(what);
    return result;
}

/// Owner of one HDF5 identifier.
class Handle {
public:
    using Close = herr_t (*)(hid_t);

    Handle() = default;
    /// @throws Error if `id` is negative
    Handle(hid_t id, Close closer, const std::string& what) : id_(checked(id, what)), close_(closer) {}
    ~Handle() { reset(); }
    Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
    Handle& operator=(Handle&& other) noexcept {
        if (this != &other) {
            reset();
            id_ = std::exchange(other.id_, -1);
            close_ = other.close_;
        }
        return *this;
    }

    [[nodiscard]] hid_t get() const { return id_; }

    /// Closes now. Closing a file writes, and so can fail, which the destructor could not tell.
    /// @throws Error
    void close(const std::string& what) {
        const hid_t id = std::exchange(id_, -1);
        if (id >= 0) checked(close_(id), what);
    }

private:
    void reset() noexcept {
        const hid_t id = std::exchange(id_, -1);
        if (id >= 0) close_(id);
    }

    hid_t id_ = -1;
    Close close_ = nullptr;
};

/// A new property list of `property_class` (H5P_...).
Handle property_list(hid_t property_class);

/// File access without locks: network file systems often refuse them, and no file is read while
/// it is written. Closing a file that still has open objects fails.
Handle file_access();

/// UTF-8 string type of `bytes` bytes (at least 1), padded with NUL.
Handle string_type(std::size_t bytes);

/// Extent of `shape` (rank 0 = scalar).
Handle extent(int rank, const hsize_t* shape);

}  // namespace lumenline::hdf
