#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace lumenline {

/// Does a cell's text stand for no value? The empty one does, and "n/a", as in BIDS.
bool is_missing(std::string_view text);

/// The number that all of a cell's text says; none where it is no number, or one that a double cannot hold.
std::optional<double> number_of(std::string_view text);

/// A column of a table: one value per row.
struct DataColumn {
    std::string name, units, description;
    bool is_measure = false;  ///< holds quantities, not counts, indices or names
    std::variant<std::vector<double>, std::vector<std::string>> values;  ///< NaN, empty text and "n/a" = no value
    bool is_whole = false;  ///< its numbers are counts or indices

    [[nodiscard]] bool is_number() const { return values.index() == 0; }
    [[nodiscard]] const std::vector<double>& numbers() const { return std::get<0>(values); }
    [[nodiscard]] const std::vector<std::string>& texts() const { return std::get<1>(values); }
};

/// A table of an archive's index: columns of equal length.
struct DataTable {
    std::string name;
    std::size_t rows = 0;
    std::vector<DataColumn> columns;

    /// @returns null if there is no such column
    [[nodiscard]] const DataColumn* find(std::string_view column) const {
        for (const DataColumn& c : columns)
            if (c.name == column) return &c;
        return nullptr;
    }
};

}  // namespace lumenline
