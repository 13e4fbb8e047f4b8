#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "engine/core/vec3.h"
#include "io/archive/read.h"
#include "io/archive/specification.h"
#include "io/archive/validate.h"

namespace lumenline {

/// One record (a model or an index) while it is held against its specification.
class Inspection {
public:
    using Numbers = std::vector<double>;

    /// @param label  how findings call the file
    Inspection(const ArchiveFile& file, std::string label, const std::vector<Specified>& specification,
               Validation& result)
        : file_(file), label_(std::move(label)), specification_(specification), result_(result) {}

    [[nodiscard]] const ArchiveFile& file() const { return file_; }
    [[nodiscard]] const std::vector<Specified>& specification() const { return specification_; }
    [[nodiscard]] Validation& result() { return result_; }

    /// Adds a finding; the dataset is no longer sound.
    void report(const std::string& place, const std::string& what);

    /// Sound is a dataset that is there and as specified, as far as was looked.
    void call_sound(const std::string& path) { sound_.insert(path); }
    [[nodiscard]] bool is_sound(const std::string& path) const { return sound_.contains(path); }
    [[nodiscard]] bool are_sound(std::initializer_list<const names::Field*> fields) const;

    /// Values, kept for later checks. What cannot be read is reported, and then there are none.
    const Numbers& numbers(const std::string& path);
    const Numbers& numbers(const names::Field& field) { return numbers(std::string(field.path)); }
    std::vector<std::string> strings(const std::string& path);

    /// Lengths of io/ARCHIVE.md, by their letter; 0 where nothing in the file has that length.
    std::map<char, std::size_t> lengths;

    [[nodiscard]] std::size_t length(char letter) const;

    /// Reports how many of `count` items do not hold, and the first of them.
    /// @param tell  what is wrong with an item, as "site 3 ..."; empty = it holds
    void all_hold(const std::string& place, std::size_t count, const std::function<std::string(std::size_t)>& tell);

private:
    const ArchiveFile& file_;
    std::string label_;
    const std::vector<Specified>& specification_;
    Validation& result_;
    std::set<std::string> sound_;
    std::map<std::string, Numbers> cache_;
};

inline Vec3 point_at(const std::vector<double>& xyz, std::size_t row) {
    return {xyz[3 * row], xyz[3 * row + 1], xyz[3 * row + 2]};
}

/// Also if both are NaN.
inline bool same_number(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

/// Which datasets and attributes are there, of which type, shape and unit: sets lengths and what is sound.
void check_structure(Inspection& inspection, const std::vector<SpecifiedAttribute>& attributes, bool failed,
                     const std::string& length_unit);
/// Each value by itself, by the rule of its dataset.
void check_values(Inspection& inspection);
/// The surface: closed, manifold, of the genus stated; counts and the copies for VTK.
void check_surface(Inspection& inspection);
/// The complex and what the wall has from it: balls touch their sites, eqs. 6 to 8.
void check_complex(Inspection& inspection);
/// Lines, their paths, the graph of branches and its tables.
void check_lines(Inspection& inspection);

}  // namespace lumenline
