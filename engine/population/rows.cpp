#include "engine/population/rows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>

#include "engine/core/text.h"

namespace lumenline {

namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

struct Condition {
    const DataColumn* column;
    std::string op, value;
    std::optional<double> number;  ///< of the value, where numbers are compared

    template <class T>
    [[nodiscard]] bool compare(const T& a, const T& b) const {
        if (op == "=") return a == b;
        if (op == "!=") return a != b;
        if (op == "<") return a < b;
        if (op == "<=") return a <= b;
        return op == ">" ? a > b : a >= b;
    }
    [[nodiscard]] bool holds(std::size_t row) const {
        if (is_missing(value)) return is_missing(*column, row) == (op == "=");
        if (is_missing(*column, row)) return false;
        if (!number) return compare(column->texts()[row], value);
        return compare(column->is_number() ? column->numbers()[row] : *number_of(column->texts()[row]), *number);
    }
};

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(' ');
    return first == text.npos ? std::string_view{} : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

/// The number that a condition compares with; none where it compares text, or asks what is missing.
/// @param text  the condition as it was written
std::optional<double> number_in(const Condition& condition, const std::string& text) {
    const DataColumn& column = *condition.column;
    const bool orders = condition.op.front() == '<' || condition.op.front() == '>';
    const bool asks_missing = is_missing(condition.value) && !orders;
    if (asks_missing || (!column.is_number() && !orders)) return std::nullopt;
    if (!column.is_number())
        for (const std::string& cell : column.texts())
            if (!is_missing(cell) && !number_of(cell))
                throw StudyError("the condition '" + text + "' orders the texts of '" + column.name + "', and '" +
                                 cell + "' is no number: compare them by = or !=");
    const std::optional<double> number = number_of(condition.value);
    if (!number || std::isnan(*number))
        throw StudyError("the condition '" + text + "' compares the numbers of '" + column.name + "' with '" +
                         condition.value + "', which is no number, or out of range");
    return number;
}

Condition parse(const DataTable& table, const std::string& text) {
    const std::size_t at = text.find_first_of("=!<>");
    const std::size_t end = at == text.npos ? text.npos : text.find_first_not_of("=!<>", at);
    const std::string op = at == text.npos ? "" : text.substr(at, (end == text.npos ? text.size() : end) - at);
    constexpr std::array<std::string_view, 6> kOperators{"=", "!=", "<", "<=", ">", ">="};
    if (std::find(kOperators.begin(), kOperators.end(), op) == kOperators.end())
        throw StudyError("the condition '" + text + "' is none: write COLUMN OP VALUE, OP one of = != < <= > >=");
    const std::string_view all = text;
    Condition condition{&column_of(table, trimmed(all.substr(0, at))), op,
                        std::string(end == text.npos ? std::string_view{} : trimmed(all.substr(end))), std::nullopt};
    condition.number = number_in(condition, text);
    return condition;
}

std::vector<Condition> parse_all(const DataTable& table, const std::vector<std::string>& texts) {
    std::vector<Condition> conditions;
    for (const std::string& text : texts) conditions.push_back(parse(table, text));
    return conditions;
}

bool all_hold(const std::vector<Condition>& conditions, std::size_t row) {
    return std::all_of(conditions.begin(), conditions.end(), [row](const Condition& c) { return c.holds(row); });
}

}  // namespace

std::string Coverage::reasons() const {
    std::string text;
    for (const auto& [reason, rows] : left_out)
        text += (text.empty() ? "" : ", ") + std::to_string(rows) + " " + reason;
    return text;
}

void leave_out(Coverage& coverage, const std::string& reason, std::size_t rows) {
    if (rows == 0) return;
    for (auto& [known, count] : coverage.left_out)
        if (known == reason) {
            count += rows;
            return;
        }
    coverage.left_out.emplace_back(reason, rows);
}

bool is_missing(const DataColumn& column, std::size_t row) {
    return column.is_number() ? std::isnan(column.numbers()[row]) : is_missing(column.texts()[row]);
}

std::string cell_text(const DataColumn& column, std::size_t row) {
    if (is_missing(column, row)) return "";
    return column.is_number() ? exact_text(column.numbers()[row]) : column.texts()[row];
}

const DataColumn& column_of(const DataTable& table, std::string_view name) {
    if (const DataColumn* column = table.find(name)) return *column;
    std::string known;
    for (const DataColumn& c : table.columns) known += (known.empty() ? "" : ", ") + c.name;
    throw StudyError("the table '" + table.name + "' has no column '" + std::string(name) + "'; it has " + known);
}

const DataColumn& numbers_of(const DataTable& table, std::string_view name) {
    const DataColumn& column = column_of(table, name);
    if (!column.is_number())
        throw StudyError("the column '" + std::string(name) + "' of the table '" + table.name +
                         "' holds text, numbers are needed");
    return column;
}

std::vector<std::size_t> select_rows(const DataTable& table, const StudyOptions& options, Coverage& coverage) {
    const std::vector<Condition> conditions = parse_all(table, options.where);
    const DataColumn* const status = table.find("status");
    const DataColumn* const rating = table.find("rating");
    std::vector<std::size_t> rows;
    coverage.rows_in = table.rows;
    for (std::size_t i = 0; i < table.rows; ++i) {
        if (status != nullptr && cell_text(*status, i) == "failed")
            leave_out(coverage, "failed");
        else if (rating != nullptr && cell_text(*rating, i) == "bad")
            leave_out(coverage, "rated bad");
        else if (!all_hold(conditions, i))
            leave_out(coverage, "outside of the conditions");
        else
            rows.push_back(i);
    }
    coverage.rows_used = rows.size();
    return rows;
}

std::vector<std::size_t> rows_where(const DataTable& table, const std::vector<std::string>& conditions) {
    const std::vector<Condition> parsed = parse_all(table, conditions);
    std::vector<std::size_t> rows;
    for (std::size_t i = 0; i < table.rows; ++i)
        if (all_hold(parsed, i)) rows.push_back(i);
    return rows;
}

std::vector<std::string> condition_columns(const DataTable& table, const std::vector<std::string>& conditions) {
    std::vector<std::string> columns;
    for (const Condition& condition : parse_all(table, conditions)) columns.push_back(condition.column->name);
    return columns;
}

bool natural_less(std::string_view a, std::string_view b) {
    std::size_t i = 0, j = 0;
    while (i < a.size() && j < b.size()) {
        if (is_digit(a[i]) && is_digit(b[j])) {
            const auto number = [](std::string_view text, std::size_t& at) {
                while (at < text.size() && text[at] == '0') ++at;
                const std::size_t first = at;
                while (at < text.size() && is_digit(text[at])) ++at;
                return text.substr(first, at - first);
            };
            const std::string_view na = number(a, i), nb = number(b, j);
            if (na.size() != nb.size()) return na.size() < nb.size();
            if (na != nb) return na < nb;
            continue;
        }
        if (a[i] != b[j]) return a[i] < b[j];
        ++i;
        ++j;
    }
    const std::size_t left_a = a.size() - i, left_b = b.size() - j;
    return left_a != left_b ? left_a < left_b : a < b;
}

}  // namespace lumenline
