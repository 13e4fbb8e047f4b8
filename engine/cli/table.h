#pragma once

#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/model_record.h"

namespace lumenline {

/// Text in columns, for people: numbers to the right, everything else to the left.
class TextTable {
public:
    enum class Align { kLeft, kRight };

    /// Adds a column; all columns are added before the first row.
    void add_column(std::string heading, Align align);
    /// Adds a row with one cell per column. Control characters are shown as '?'.
    void add_row(const std::vector<std::string>& cells);
    /// Writes the headings, then the rows, two spaces between columns.
    void print(std::ostream& out) const;

private:
    std::vector<std::vector<std::string>> rows_{{}};  ///< the first one holds the headings
    std::vector<Align> aligns_;
};

/// `value` with four significant digits, without an exponent between 1e-4 and 1e9; "-" for NaN.
std::string table_number(double value);

/// A column to print beside those of `print_models`, one cell per model.
struct MoreColumn {
    std::string heading;
    bool is_number = false;
    std::vector<std::string> cells;
};

/// Writes one row per model: id, status, endpoints, sites, lines, their length and radii, seconds, and what is asked for
/// beside; "-" for what a model does not have. Headings name the unit if all models share one.
void print_models(std::ostream& out, const std::vector<ModelSummary>& models, const std::vector<MoreColumn>& more = {});

/// Is it a column that `print_models` has of its own?
bool is_printed_column(std::string_view name);

}  // namespace lumenline
