// A length is what most datasets say it is: if it were taken from the first one, a single array that is cut short would
// make all others look wrong.

#include <algorithm>
#include <charconv>

#include "io/archive/index_names.h"
#include "io/archive/inspection.h"

namespace lumenline {

namespace {

std::vector<std::string> split(const std::string& text, const std::string& separator) {
    std::vector<std::string> parts;
    if (text.empty()) return parts;
    std::size_t from = 0;
    for (std::size_t at = 0; (at = text.find(separator, from)) != text.npos; from = at + separator.size())
        parts.push_back(text.substr(from, at - from));
    parts.push_back(text.substr(from));
    return parts;
}

bool is_letter(char c) { return c >= 'A' && c <= 'Z'; }

/// Value of a sum of numbers, letters and multiples of letters, as "3M+K".
std::uint64_t evaluated(const std::string& sum, const Inspection& inspection) {
    std::uint64_t value = 0;
    for (const std::string& term : split(sum, "+")) {
        std::uint64_t factor = 1;
        std::from_chars(term.data(), term.data() + term.size(), factor);
        value += is_letter(term.back()) ? factor * inspection.length(term.back()) : factor;
    }
    return value;
}

using Nodes = std::map<std::string, ArchiveNode>;

/// The dataset of each row of the specification; covariates have none.
void find_lengths(Inspection& inspection, const Nodes& nodes) {
    std::map<char, std::map<std::size_t, std::size_t>> votes;
    for (const Specified& entry : inspection.specification()) {
        const auto node = nodes.find(entry.path);
        const std::vector<std::string> shape = split(entry.shape, ", ");
        if (node == nodes.end() || node->second.shape.size() != shape.size()) continue;
        for (std::size_t d = 0; d < shape.size(); ++d) {
            const std::size_t own = node->second.shape[d];
            if (shape[d].size() == 1 && is_letter(shape[d][0])) ++votes[shape[d][0]][own];
            if (shape[d].size() == 3 && shape[d].ends_with("+1") && own > 0) ++votes[shape[d][0]][own - 1];
        }
    }
    for (const auto& [letter, counts] : votes)
        inspection.lengths[letter] = std::max_element(counts.begin(), counts.end(), [](const auto& a, const auto& b) {
                                         return a.second < b.second || (a.second == b.second && a.first < b.first);
                                     })->first;
}

void check_dataset(Inspection& inspection, const Specified& entry, const ArchiveNode& node, const std::string& unit) {
    const std::vector<std::string> types = split(entry.types, " or "), shape = split(entry.shape, ", ");
    if (std::find(types.begin(), types.end(), node.type) == types.end())
        return inspection.report(node.path, "its type is " + node.type + ", not " + entry.types);
    std::vector<std::uint64_t> expected;
    for (const std::string& length : shape) expected.push_back(evaluated(length, inspection));
    if (node.shape != expected)
        return inspection.report(node.path, "its shape is " + shape_text(node.shape) + ", not " + shape_text(expected) +
                                                (entry.shape.empty() ? "" : " = (" + entry.shape + ")"));
    std::string units = entry.units;
    if (const std::size_t at = units.find(names::kLength); at != units.npos)
        units.replace(at, names::kLength.size(), unit);
    if (node.units != units)
        inspection.report(node.path + "@units", "the unit is '" + node.units + "', not '" + units + "'");
    if (node.description.empty()) inspection.report(node.path + "@description", "is missing or empty");
    inspection.call_sound(node.path);
}

/// The parts that a file must have: those that every one has, and those of which it has anything.
std::set<Part> required_parts(const Inspection& inspection, const Nodes& nodes, bool failed) {
    using enum Part;
    std::set<Part> there{kAlways}, parts;
    for (const Specified& entry : inspection.specification())
        if (nodes.contains(entry.path)) there.insert(entry.part);
    const std::string fields = inspection.file().attribute("/", "fields").value_or("all");
    if (!failed) there.insert({kEndpoints, kLines});
    if (!failed && fields != "lines") there.insert(kSurface);
    if (!failed && fields == "all") there.insert({kVoronoi, kFronts});
    for (const Part part : {kAlways, kSurface, kVoronoi, kEndpoints, kFronts, kLines, kStatistics, kBranches})
        if (there.contains(part)) parts.insert(part);
    if (there.contains(kCharacter) && !parts.contains(kStatistics)) parts.insert(kStatistics);
    if (parts.contains(kSurface) || parts.contains(kLines)) parts.insert(kVtk);
    if (parts.contains(kStatistics) && parts.contains(kSurface)) parts.insert(kCharacter);
    if (parts.contains(kStatistics) && parts.contains(kVoronoi)) parts.insert(kVertexCharacter);
    if (parts.contains(kSurface) && parts.contains(kVoronoi)) parts.insert(kPoles);
    if (parts.contains(kCharacter) && parts.contains(kBranches)) parts.insert(kSiteBranches);
    return parts;
}

void check_attributes(Inspection& inspection, const Nodes& nodes, const std::vector<SpecifiedAttribute>& attributes,
                      bool failed) {
    for (const SpecifiedAttribute& entry : attributes) {
        const bool is_root = std::string_view(entry.object) == "/";
        if (!is_root && !nodes.contains(entry.object)) continue;
        const std::string place = std::string(entry.object) + "@" + entry.name;
        const std::optional<std::string> text = inspection.file().attribute(entry.object, entry.name);
        const bool is_signal = std::string_view(entry.name) == "failure_signal";
        if (!text) {
            if (entry.presence == Presence::kAlways ||
                (failed == (entry.presence == Presence::kIfFailed) && !is_signal))
                inspection.report(place, "is missing");
            continue;
        }
        if (entry.presence == Presence::kIfFailed && !failed)
            inspection.report(place, "is there, but the model did not fail");
        if (std::string_view(entry.type) == "string") continue;
        double number = 0;
        const auto read = std::from_chars(text->data(), text->data() + text->size(), number);
        const bool is_list = std::string_view(entry.name) == "Version";
        if (read.ec != std::errc() || (!is_list && read.ptr != text->data() + text->size()))
            inspection.report(place, "is '" + *text + "', not a number of type " + entry.type);
        else if (const auto length = inspection.lengths.find(entry.counts);
                 length != inspection.lengths.end() && number != static_cast<double>(length->second))
            inspection.report(place, "is " + *text + ", but the file has " + std::to_string(length->second));
    }
}

/// A column of the table of models that is no column of ours: a covariate.
void check_covariate(Inspection& inspection, const ArchiveNode& node) {
    const auto& all = inspection.specification();
    const auto entry =
        std::find_if(all.begin(), all.end(), [](const Specified& s) { return s.path == names::kAnyCovariate; });
    if (entry != all.end()) check_dataset(inspection, *entry, node, "");
}

}  // namespace

void check_structure(Inspection& inspection, const std::vector<SpecifiedAttribute>& attributes, bool failed,
                     const std::string& length_unit) {
    Nodes nodes;
    for (ArchiveNode& node : inspection.file().nodes()) nodes.emplace(node.path, std::move(node));
    find_lengths(inspection, nodes);
    check_attributes(inspection, nodes, attributes, failed);
    const std::set<Part> parts = required_parts(inspection, nodes, failed);
    std::set<std::string> known;
    for (const Specified& entry : inspection.specification()) {
        known.insert(entry.path);
        const auto node = nodes.find(entry.path);
        if (node == nodes.end()) {
            if (parts.contains(entry.part) && entry.path != names::kAnyCovariate)
                inspection.report(entry.path, "is missing");
        } else if (node->second.is_group) {
            inspection.report(entry.path, "is a group, not a dataset");
        } else {
            ++inspection.result().datasets;
            check_dataset(inspection, entry, node->second, length_unit);
        }
    }
    for (const auto& [path, node] : nodes) {
        if (node.is_group || known.contains(path) || path.starts_with("/models/")) continue;  // of a packed archive
        if (inspection.file().attribute(path, "column"))
            check_covariate(inspection, node);
        else
            ++inspection.result().others;
    }
}

}  // namespace lumenline
