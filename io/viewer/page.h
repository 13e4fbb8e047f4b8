#pragma once

#include <string>
#include <string_view>

namespace lumenline {

/// The page that shows an archive (io/viewer/src), as it is built and committed: one gzipped file of HTML.
std::string_view page_gzip();

/// The same, as text. It holds kArchiveMark once.
/// @throws std::runtime_error if the embedded bytes are damaged
std::string page_html();

/// Where blocks of data may be put into the page, each
/// `<script type="application/octet-stream" data-lumenline-file="PATH" data-lumenline-name="NAME">BASE64</script>`:
/// a page that has such blocks shows these files as its archive, the first of them as its index.
inline constexpr std::string_view kArchiveMark = "<!--archive-->";

/// Content-security policy under which the page runs, as the value of the HTTP header.
std::string_view page_policy();

}  // namespace lumenline
