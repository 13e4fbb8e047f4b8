#pragma once

#include <string>
#include <string_view>

namespace lumenline {

/// The page that shows an archive (io/viewer/src), as it is built and committed: gzipped HTML that holds kBlocksMark
/// once.
std::string_view page_gzip();

/// The WebAssembly of the HDF5 library that the page asks its server for at `hdf5.wasm`, gzipped.
std::string_view page_library_gzip();

/// Bytes of one of these.
/// @throws std::runtime_error if the embedded bytes are damaged
std::string unpacked(std::string_view packed);

/// Where blocks of data may be put into the page. A page without a server needs the gzipped library,
/// `<script type="application/octet-stream" id="hdf5-library">BASE64</script>`, and has any files of an archive, each
/// `<script type="application/octet-stream" data-lumenline-file="PATH" data-lumenline-name="NAME">BASE64</script>`:
/// it shows these files as its archive, the first of them as its index.
inline constexpr std::string_view kBlocksMark = "<!--blocks-->";

/// Content-security policy under which the page runs, as the value of the HTTP header.
std::string_view page_policy();

}  // namespace lumenline
