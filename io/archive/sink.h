#pragma once

#include <filesystem>

#include "io/archive/handle.h"

namespace lumenline::hdf {

/// The bytes of an HDF5 file that is being written. HDF5 never learns that a write failed: the
/// first error is kept here, and everything after it is thrown away.
class Sink {
public:
    /// Creates `file`, or empties it.
    /// @throws std::system_error
    explicit Sink(const std::filesystem::path& file);
    ~Sink();
    Sink(const Sink&) = delete;
    Sink& operator=(const Sink&) = delete;

    /// File access whose files write here. They must be closed before the sink is destroyed.
    [[nodiscard]] Handle access();

    /// Throws std::system_error if anything was thrown away.
    void require_good() const;

    /// Throws away everything that comes from now on.
    void discard();

    struct State {
        int descriptor = -1;
        int error = 0;  ///< errno of the first failed write
    };

private:
    std::filesystem::path file_;
    State state_;
    Handle driver_;
};

}  // namespace lumenline::hdf
