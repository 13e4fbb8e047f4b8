// The one list of keys: the reader refuses whatever is not in it and takes limits and choices from it.

#include "config/keys.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cctype>

#include "engine/core/text.h"

namespace lumenline {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

constexpr std::array kKeys{
    KeyInfo{"cohort", "text", "", "-", "required"},
    KeyInfo{"length_unit", "text", "", "-", "unknown"},
    KeyInfo{"coordinate_system", "choice", "LPS|RAS|unknown", "-", "unknown"},
    KeyInfo{"models", "list or map", "", "-", "required"},
    KeyInfo{"models.list", "list", "", "-", "-"},
    KeyInfo{"models.list[].id", "text", "", "-", "required"},
    KeyInfo{"models.list[].surface", "path", "", "-", "required"},
    KeyInfo{"models.list[].subject", "text", "", "-", "\"\""},
    KeyInfo{"models.list[].session", "text", "", "-", "\"\""},
    KeyInfo{"models.list[].side", "text", "", "-", "\"\""},
    KeyInfo{"models.list[].structure", "text", "", "-", "\"\""},
    KeyInfo{"models.list[].group", "text", "", "-", "\"\""},
    KeyInfo{"models.list[].inlets", "points or text", "", "length", "[]"},
    KeyInfo{"models.list[].outlets", "points", "", "length", "[]"},
    KeyInfo{"models.list[].scale", "number", "", "length per file unit", "1", {0, kInfinity, true}},
    KeyInfo{"models.list[].branch_labels", "map of texts", "", "-", "{}"},
    KeyInfo{"models.list[].covariates", "map of texts", "", "-", "{}"},
    KeyInfo{"models.table", "path", "", "-", "-"},
    KeyInfo{"models.glob", "path", "", "-", "-"},
    KeyInfo{"endpoints", "map", "", "-", "{}"},
    KeyInfo{"endpoints.mode", "choice", "auto|boundaries|caps|tips|points", "-", "auto"},
    KeyInfo{"endpoints.inlet", "text", "", "-", "largest"},
    KeyInfo{"endpoints.tip_length", "number", "", "local radii", "3", {1, 1000, false}},
    KeyInfo{"condition", "map", "", "-", "{}"},
    KeyInfo{"condition.weld_tolerance", "number", "", "bounding box diagonals", "1e-07", {0, 0.01, false}},
    KeyInfo{"condition.extension_radii", "number", "", "opening radii", "1.2", {0, 100, false}},
    KeyInfo{"condition.check_self_intersections", "boolean", "", "-", "true"},
    KeyInfo{"condition.drop_faces", "boolean", "", "-", "true"},
    KeyInfo{"condition.orient_faces", "boolean", "", "-", "true"},
    KeyInfo{"condition.split_non_manifold", "boolean", "", "-", "true"},
    KeyInfo{"condition.fill_holes", "boolean", "", "-", "true"},
    KeyInfo{"condition.repair_self_intersections", "boolean", "", "-", "true"},
    KeyInfo{"condition.speck_share", "number", "", "share of the area", "0.001", {0, 0.5, false}},
    KeyInfo{"condition.components", "choice", "fail|largest|each", "-", "each"},
    KeyInfo{"condition.refine_undersampled", "boolean", "", "-", "true"},
    KeyInfo{"condition.decimate", "number", "off", "bounding box diagonals", "off", {0, 0.1, true}},
    KeyInfo{"centerlines", "map", "", "-", "{}"},
    KeyInfo{"centerlines.refine", "choice", "none|path|medial", "-", "medial"},
    KeyInfo{"centerlines.pairs", "choice", "nearest|all", "-", "nearest"},
    KeyInfo{"centerlines.join", "choice", "axis|centre", "-", "axis"},
    KeyInfo{"centerlines.topology", "choice", "tree|network", "-", "tree"},
    KeyInfo{"characterize", "boolean", "", "-", "true"},
    KeyInfo{"branches", "boolean or map", "", "-", "{}"},
    KeyInfo{"branches.enabled", "boolean", "", "-", "true"},
    KeyInfo{"branches.step", "number", "", "mean radii", "0.25", {0.01, 10, false}},
    KeyInfo{"branches.smoothing", "number", "", "local radii", "2", {0.1, 100, false}},
    KeyInfo{"branches.section_step", "number", "", "mean radii", "0.5", {0.01, 100, false}},
    KeyInfo{"branches.patches_along", "integer", "", "bins", "10", {1, 1000, false}},
    KeyInfo{"branches.patches_around", "integer", "", "bins", "12", {1, 1000, false}},
    KeyInfo{"population", "map", "", "-", "{}"},
    KeyInfo{"population.labels", "choice", "position|given|template|none", "-", "position"},
    KeyInfo{"population.template", "text", "", "-", "\"\""},
    KeyInfo{"population.directions", "choice", "angles|axes", "-", "angles"},
    KeyInfo{"population.label_table", "path", "", "-", "-"},
    KeyInfo{"run", "map", "", "-", "{}"},
    KeyInfo{"run.threads", "integer", "all", "threads", "all", {1, 4096, false}},
    KeyInfo{"run.models_in_flight", "integer", "auto", "models", "auto", {1, 65536, false}},
    KeyInfo{"run.memory", "size", "", "-", "70%"},
    KeyInfo{"run.model_timeout", "duration", "off", "-", "off"},
    KeyInfo{"run.model_memory", "size", "off", "-", "off"},
    KeyInfo{"run.isolation", "choice", "none|process", "-", "none"},
    KeyInfo{"archive", "map", "", "-", "{}"},
    KeyInfo{"archive.directory", "path", "", "-", "results"},
    KeyInfo{"archive.fields", "choice", "all|surface|lines", "-", "all"},
    KeyInfo{"archive.precision", "choice", "float32|float64", "-", "float32"},
};

char lower(char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); }

}  // namespace

std::span<const KeyInfo> all_keys() { return kKeys; }

const KeyInfo& key_info(std::string_view path) {
    const auto found = std::ranges::find(kKeys, path, &KeyInfo::path);
    assert(found != kKeys.end());
    return *found;
}

std::vector<std::string_view> key_names(std::string_view path) {
    std::vector<std::string_view> names;
    for (const KeyInfo& key : kKeys) {
        const std::size_t dot = key.path.rfind('.');
        const std::string_view parent = dot == std::string_view::npos ? "" : key.path.substr(0, dot);
        if (parent == path) names.push_back(dot == std::string_view::npos ? key.path : key.path.substr(dot + 1));
    }
    return names;
}

std::vector<std::string_view> choice_words(const KeyInfo& key) {
    std::vector<std::string_view> words;
    for (std::string_view rest = key.choices; !rest.empty();) {
        const std::size_t bar = std::min(rest.find('|'), rest.size());
        words.push_back(rest.substr(0, bar));
        rest.remove_prefix(std::min(bar + 1, rest.size()));
    }
    return words;
}

std::string limits_text(const Limits& limits) {
    if (limits.low == -kInfinity) return "any";
    if (limits.high == kInfinity) return (limits.low_excluded ? "> " : ">= ") + short_text(limits.low);
    return short_text(limits.low) + " to " + short_text(limits.high, 9);
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
    // Three rolling rows of the usual table: the transposition looks two rows back.
    std::vector<std::size_t> before(b.size() + 1), above(b.size() + 1), row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        before.swap(above);
        above.swap(row);
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const bool same = lower(a[i - 1]) == lower(b[j - 1]);
            row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + (same ? 0 : 1)});
            const bool swapped =
                i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) && lower(a[i - 2]) == lower(b[j - 1]);
            if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
        }
    }
    return row[b.size()];
}

std::string_view nearest_word(std::string_view word, std::span<const std::string_view> words) {
    constexpr std::size_t kLongest = 64;  // no key is longer, and the table is quadratic
    if (word.size() > kLongest) return {};
    std::string_view nearest;
    std::size_t least = 1 + word.size() / 3;
    for (const std::string_view candidate : words) {
        const std::size_t distance = edit_distance(word, candidate);
        // A distance of the whole candidate means that nothing is shared.
        if (distance <= least && distance < candidate.size() && (nearest.empty() || distance < least)) {
            nearest = candidate;
            least = distance;
        }
    }
    return nearest;
}

std::string spoken_list(std::span<const std::string_view> words) {
    std::string text;
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (i > 0) text += i + 1 == words.size() ? " or " : ", ";
        text += words[i];
    }
    return text;
}

}  // namespace lumenline
