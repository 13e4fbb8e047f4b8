#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "io/archive/names.h"

namespace lumenline {

/// Which values a dataset may hold, each one taken for itself.
struct Rule {
    double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
    bool above_low = false;          ///< `low` itself is none of them
    bool none = false;               ///< NaN means that there is no value
    bool unreached = false;          ///< +inf means that no front came there
    char index_of = '\0';            ///< from `low` to one less than that length of io/ARCHIVE.md
    bool whole = false;              ///< counts, codes and indices
    bool is_unit = false;            ///< each row is a vector of length one
    bool may_be_zero = false;        ///< ... or zero
    char offsets_of = '\0';          ///< starts of ragged parts of arrays of that length
    const char* rises_by = nullptr;  ///< within each part of these offsets the values never fall
    const char* words = nullptr;     ///< of text: these, with | between
};

/// Datasets that are written together: where one of them is, all are.
enum class Part {
    kAlways,           ///< in each file
    kSurface,          ///< in each model that did not fail, unless its fields are the lines alone
    kPoles,            ///< with kSurface and kVoronoi
    kVoronoi,          ///< in each model that did not fail, if its fields are all
    kEndpoints,        ///< in each model that did not fail
    kFronts,           ///< as kVoronoi
    kLines,            ///< in each model that did not fail
    kStatistics,       ///< where it was asked for
    kCharacter,        ///< with kStatistics and kSurface
    kVertexCharacter,  ///< with kStatistics and kVoronoi
    kBranches,         ///< where it was asked for
    kSiteBranches,     ///< with kCharacter and kBranches
    kVtk,              ///< with kSurface, and with kLines
};

/// A dataset as io/ARCHIVE.md has it.
struct Specified {
    std::string path;
    std::string shape;  ///< "N, 3", "3M+K"; empty = scalar
    std::string types;  ///< "float32 or float64"
    std::string units;  ///< "length" stands for the model's unit
    Part part = Part::kAlways;
    Rule rule;
};

enum class Presence { kAlways, kIfFailed, kUnlessFailed };

/// An attribute as io/ARCHIVE.md has it. One of a group is there where the group is.
struct SpecifiedAttribute {
    const char* object;
    const char* name;
    const char* type;
    Presence presence = Presence::kAlways;
    char counts = '\0';  ///< it is that length of io/ARCHIVE.md
};

/// The specification of a model file, and of an index, in the order of io/ARCHIVE.md. A covariate's column is
/// "/tables/models/<covariate>".
const std::vector<Specified>& model_specification();
const std::vector<SpecifiedAttribute>& model_attributes();
const std::vector<Specified>& index_specification();
const std::vector<SpecifiedAttribute>& index_attributes();

namespace names {
inline constexpr std::string_view kAnyCovariate = "/tables/models/<covariate>";
}

/// Rules by the names that the specification's tables use.
namespace rules {

constexpr Rule any() { return {.none = true, .unreached = true}; }
constexpr Rule finite() { return {}; }
constexpr Rule or_none(Rule rule) {
    rule.none = true;
    return rule;
}
constexpr Rule or_unreached(Rule rule) {
    rule.unreached = true;
    return rule;
}
constexpr Rule positive() { return {.low = 0, .above_low = true}; }
constexpr Rule not_negative() { return {.low = 0}; }
constexpr Rule within(double low, double high) { return {.low = low, .high = high}; }
constexpr Rule share() { return within(0, 1); }
constexpr Rule code(double last) { return {.low = 0, .high = last, .whole = true}; }
constexpr Rule count() { return {.low = 0, .whole = true}; }
constexpr Rule index(char length, double least = 0) { return {.low = least, .index_of = length, .whole = true}; }
constexpr Rule index_or_none(char length) { return index(length, -1); }
constexpr Rule unit() { return {.is_unit = true}; }
constexpr Rule unit_or_zero() { return {.is_unit = true, .may_be_zero = true}; }
constexpr Rule unit_or_none() { return {.none = true, .is_unit = true}; }
constexpr Rule offsets(char length) { return {.low = 0, .whole = true, .offsets_of = length}; }
constexpr Rule rising(const names::Field& offsets) { return {.low = 0, .rises_by = offsets.path}; }
constexpr Rule words(const char* words) { return {.words = words}; }
constexpr Rule text() { return {}; }

}  // namespace rules

/// The table of a model or index: what columns may hold, for the datasets of `table` below `prefix`.
/// @param rows  their common length, as a letter of io/ARCHIVE.md
/// @param with_indices  indices point into the same file; else into those of many models
void add_columns(std::vector<Specified>& specification, const std::string& prefix, const struct Table& table, char rows,
                 Part part, bool with_indices);

}  // namespace lumenline
