// Each rule is a pass of its own over the values, so that a finding says which rule is broken and at which place first.

#include <algorithm>
#include <cmath>

#include "engine/core/text.h"
#include "io/archive/inspection.h"

namespace lumenline {

namespace {

/// How far a unit vector may be from length one: what rounding leaves after it was divided by its length and stored.
constexpr double kUnitSlack = 1e-9;

std::string at_place(const std::string& what, std::size_t k) { return what + " at " + std::to_string(k); }

bool is_allowed(const Rule& rule, double last, double value) {
    if (std::isnan(value)) return rule.none;
    if (value == std::numeric_limits<double>::infinity()) return rule.unreached;
    if (!std::isfinite(value)) return false;
    if (rule.above_low ? !(value > rule.low) : !(value >= rule.low)) return false;
    return value <= last && (!rule.whole || value == std::floor(value));
}

std::string range_text(const Rule& rule, double last) {
    const bool from = rule.low > -std::numeric_limits<double>::infinity();
    const bool to = last < std::numeric_limits<double>::infinity();
    std::string text = rule.whole ? "a whole number" : "a finite number";
    if (from) text += (rule.above_low ? " above " : " from ") + short_text(rule.low);
    if (to) text += (from ? " to " : " up to ") + short_text(last, 10);
    if (rule.none) text += ", or NaN";
    if (rule.unreached) text += ", or +inf";
    return text;
}

void check_range(Inspection& inspection, const Specified& entry, const std::vector<double>& values) {
    const Rule& rule = entry.rule;
    const double last = rule.index_of != '\0' ? static_cast<double>(inspection.length(rule.index_of)) - 1 : rule.high;
    inspection.all_hold(entry.path, values.size(), [&](std::size_t k) {
        if (is_allowed(rule, last, values[k])) return std::string();
        return at_place("the value " + short_text(values[k]) + " is not " + range_text(rule, last), k);
    });
}

void check_unit(Inspection& inspection, const Specified& entry, const std::vector<double>& values) {
    const Rule& rule = entry.rule;
    inspection.all_hold(entry.path, values.size() / 3, [&](std::size_t row) {
        const double size = norm(point_at(values, row));
        if ((std::isnan(size) && rule.none) || (size == 0 && rule.may_be_zero)) return std::string();
        if (std::fabs(size - 1) <= kUnitSlack) return std::string();
        return at_place("the vector of length " + short_text(size) + " is no unit vector", row);
    });
}

void check_offsets(Inspection& inspection, const Specified& entry, const std::vector<double>& values) {
    const auto length = static_cast<double>(inspection.length(entry.rule.offsets_of));
    if (values.empty() || values.front() != 0 || values.back() != length)
        return inspection.report(entry.path, "the offsets do not run from 0 to " + short_text(length, 10) +
                                                 ", the length of what they divide");
    inspection.all_hold(entry.path, values.size() - 1, [&](std::size_t k) {
        return values[k] <= values[k + 1] ? std::string() : at_place("the offsets fall", k + 1);
    });
}

void check_rise(Inspection& inspection, const Specified& entry, const std::vector<double>& values) {
    if (!inspection.is_sound(entry.rule.rises_by)) return;
    const std::vector<double>& offsets = inspection.numbers(std::string(entry.rule.rises_by));
    std::vector<bool> starts(values.size() + 1, false);
    for (const double offset : offsets) starts[std::min(static_cast<std::size_t>(offset), values.size())] = true;
    inspection.all_hold(entry.path, values.size(), [&](std::size_t k) {
        if (k == 0 || starts[k] || values[k] >= values[k - 1]) return std::string();
        return at_place("the value " + short_text(values[k]) + " is less than the one before it", k);
    });
}

void check_words(Inspection& inspection, const Specified& entry) {
    const std::vector<std::string> texts = inspection.strings(entry.path);  // any are to be readable
    if (entry.rule.words == nullptr) return;
    const std::string known = std::string("|") + entry.rule.words + "|";
    inspection.all_hold(entry.path, texts.size(), [&](std::size_t k) {
        const bool is_known = !texts[k].empty() && known.find("|" + texts[k] + "|") != known.npos;
        return is_known ? std::string() : at_place("'" + texts[k] + "' is none of " + entry.rule.words, k);
    });
}

}  // namespace

void check_values(Inspection& inspection) {
    for (const Specified& entry : inspection.specification()) {
        if (!inspection.is_sound(entry.path)) continue;
        if (entry.types == "string") {
            check_words(inspection, entry);
            continue;
        }
        const std::vector<double>& values = inspection.numbers(entry.path);
        check_range(inspection, entry, values);
        if (inspection.is_sound(entry.path) && entry.rule.is_unit) check_unit(inspection, entry, values);
        if (inspection.is_sound(entry.path) && entry.rule.offsets_of != '\0') check_offsets(inspection, entry, values);
        if (inspection.is_sound(entry.path) && entry.rule.rises_by != nullptr) check_rise(inspection, entry, values);
    }
}

}  // namespace lumenline
