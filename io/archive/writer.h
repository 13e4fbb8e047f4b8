#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/ids.h"
#include "engine/core/vec3.h"
#include "io/archive/handle.h"
#include "io/archive/names.h"
#include "io/archive/sink.h"

namespace lumenline::hdf {

/// Numbers as they stand in memory, and (little-endian) in the file.
enum class Number { kFloat64, kFloat32, kInt32, kInt64, kUint8 };

/// How an element of a column is stored: its number type and how many there are.
template <class T>
struct Element;
template <Number N, int kCount>
struct ElementOf {
    static constexpr Number kNumber = N;
    static constexpr int kComponents = kCount;
};
template <>
struct Element<double> : ElementOf<Number::kFloat64, 1> {};
template <>
struct Element<Vec3> : ElementOf<Number::kFloat64, 3> {};
template <>
struct Element<std::int32_t> : ElementOf<Number::kInt32, 1> {};
template <>
struct Element<std::uint32_t> : ElementOf<Number::kInt32, 1> {};
template <>
struct Element<std::int64_t> : ElementOf<Number::kInt64, 1> {};
template <>
struct Element<std::uint8_t> : ElementOf<Number::kUint8, 1> {};
template <class Tag>
struct Element<Index<Tag>> : ElementOf<Number::kInt32, 1> {};
template <class Tag, std::size_t N>
struct Element<std::array<Index<Tag>, N>> : ElementOf<Number::kInt32, N> {};
static_assert(sizeof(Vec3) == 3 * sizeof(double) && sizeof(SiteId) == sizeof(std::int32_t));

/// Some rows of a dataset, one after the other in memory.
struct Rows {
    const void* data;
    std::size_t count;
};

/// Writes one HDF5 file under its temporary name and makes it appear when it is complete.
///
/// Datasets are contiguous and uncompressed and carry `units` and `description`; groups on the way
/// are made as needed; nothing carries a time stamp, so the bytes depend on the calls alone.
/// Text is stored as valid UTF-8 of fixed length. Every function throws Error or
/// std::system_error (the disk), `column` also Inconsistent.
class Writer {
public:
    /// @param length_unit  written as the unit of every field of unit "length"
    Writer(const std::filesystem::path& file, std::string_view length_unit);
    /// Removes the temporary file unless it was committed.
    ~Writer();
    Writer(const Writer&) = delete;
    Writer& operator=(const Writer&) = delete;

    /// Makes the group and its parents if they do not exist.
    void group(const std::string& path);

    void attribute(const std::string& object, const char* name, std::string_view text);
    void attribute(const std::string& object, const char* name, const char* text) {
        attribute(object, name, std::string_view(text));
    }
    void attribute(const std::string& object, const char* name, double value);
    void attribute(const std::string& object, const char* name, int value);
    /// The two attributes that make a group a VTKHDF unstructured grid of version 1.0.
    void vtk_attributes(const std::string& object);

    /// One value per element. Indices are stored as int32: `kNone` becomes -1, larger than int32 throws.
    /// @param expected  number of elements that the rest of the record asks for
    template <class T>
    void column(const names::Field& field, const std::vector<T>& values, std::size_t expected) {
        constexpr int kComponents = Element<T>::kComponents;
        require_count(field, values.size(), expected);
        if constexpr (Element<T>::kNumber == Number::kInt32) {
            const void* data = values.data();
            require_int32(field, {static_cast<const std::int32_t*>(data), values.size() * kComponents}, kComponents);
        }
        const std::array<hsize_t, 2> shape{values.size(), kComponents};
        const Rows rows{values.data(), values.size()};
        numbers(field, {shape.data(), kComponents == 1 ? 1U : 2U}, Element<T>::kNumber, Element<T>::kNumber,
                {&rows, 1});
    }
    template <class T>
    void column(const names::Field& field, const std::vector<T>& values) {
        column(field, values, values.size());
    }

    /// A dataset of `shape` filled from parts that follow each other along its first dimension.
    void numbers(const names::Field& field, std::span<const hsize_t> shape, Number in_memory, Number in_file,
                 std::span<const Rows> parts);
    /// One value of rank 0.
    void number(const names::Field& field, double value);
    void number(const names::Field& field, std::int32_t value);
    void strings(const names::Field& field, const std::vector<std::string>& values);

    /// A dataset of `rows` values, of which `put` writes some at a time. Text has at most `width` bytes of UTF-8.
    Handle begin_numbers(const names::Field& field, std::size_t rows, Number in_file);
    Handle begin_strings(const names::Field& field, std::size_t rows, std::size_t width);
    /// Rows from `first` on. @param what  path, for messages
    void put(const Handle& dataset, const std::string& what, std::size_t first, const std::vector<double>& values);
    void put(const Handle& dataset, const std::string& what, std::size_t first, const std::vector<std::string>& values,
             std::size_t width);
    /// One text of rank 0 and any length.
    void text(const names::Field& field, std::string_view value);

    /// External link `path` -> root group of `file` (relative to the directory of this file).
    void external_link(const std::string& path, const std::string& file);

    /// What was written, in order.
    struct Described {
        std::string path, type, units, description;
    };
    [[nodiscard]] const std::vector<Described>& described() const { return described_; }

    /// Closes the file and makes it appear. Nothing can be written afterwards.
    void commit();

private:
    static void require_count(const names::Field& field, std::size_t count, std::size_t expected);
    static void require_int32(const names::Field& field, std::span<const std::int32_t> values, std::size_t components);
    Handle create(const names::Field& field, std::span<const hsize_t> shape, hid_t type, const char* type_name);
    void put(const Handle& dataset, const std::string& what, std::size_t first, std::size_t count, hid_t memory,
             const void* data);
    void make_parents(const std::string& path);

    std::filesystem::path path_;
    std::string length_unit_;
    Sink sink_;
    Handle file_;  // closed before its sink
    std::set<std::string> groups_{"/", ""};
    std::vector<Described> described_;
};

}  // namespace lumenline::hdf
