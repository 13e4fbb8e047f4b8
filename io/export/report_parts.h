#pragma once

#include <string>
#include <string_view>

#include "io/export/report.h"

namespace lumenline {

/// Text as it may stand in HTML, in an attribute too: no markup, no control characters, valid UTF-8.
std::string html_text(std::string_view text);

/// Identifier of a model's entry in the page.
std::string model_anchor(std::size_t model);

/// A number for people, with four significant digits.
std::string html_number(double value);

/// Points and boxes of one measure by group, as inline SVG. Outliers are links to their models.
std::string spread_svg(const ReportMeasure& measure, const Report& report);

}  // namespace lumenline
