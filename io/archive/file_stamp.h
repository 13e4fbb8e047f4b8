#pragma once

#include <filesystem>

namespace lumenline {

/// What the folder says of a file; NaN of one that is not there.
struct FileStamp {
    double bytes;
    double time;  ///< of the last write [s since 1970]

    /// Never of files that are not there.
    bool operator==(const FileStamp&) const = default;
};

FileStamp stamp_of(const std::filesystem::path& file);

}  // namespace lumenline
