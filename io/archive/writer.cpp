// Two writes of the same data must give the same bytes. HDF5 allows it if objects carry no time
// stamps (`track_times` off on file, groups and datasets), if everything is made in a fixed order,
// and if storage is contiguous. Text is of fixed length, because variable-length text lives in
// heaps that readers fetch piecemeal: a column of text is one contiguous block instead.
//
// An index with all bits set means "none", and the same bits read as int32 are -1, so that arrays
// of indices are written as they stand. An index of 2^31 or more would turn into another negative
// number, and is refused.

#include "io/archive/writer.h"

#include <algorithm>
#include <limits>
#include <system_error>

#include "io/archive/commit.h"
#include "io/archive/utf8.h"

namespace lumenline::hdf {

namespace {

/// Attributes live in object headers, whose messages end at 64 KiB.
constexpr std::size_t kLongestAttribute = 60000;

hid_t memory_type(Number number) {
    switch (number) {
        case Number::kFloat64: return H5T_NATIVE_DOUBLE;
        case Number::kFloat32: return H5T_NATIVE_FLOAT;
        case Number::kInt32: return H5T_NATIVE_INT32;
        case Number::kInt64: return H5T_NATIVE_INT64;
        case Number::kUint8: return H5T_NATIVE_UINT8;
    }
    return H5T_NATIVE_DOUBLE;
}

hid_t file_type(Number number) {
    switch (number) {
        case Number::kFloat64: return H5T_IEEE_F64LE;
        case Number::kFloat32: return H5T_IEEE_F32LE;
        case Number::kInt32: return H5T_STD_I32LE;
        case Number::kInt64: return H5T_STD_I64LE;
        case Number::kUint8: return H5T_STD_U8LE;
    }
    return H5T_IEEE_F64LE;
}

/// As readers call it.
const char* type_name(Number number) {
    switch (number) {
        case Number::kFloat64: return "float64";
        case Number::kFloat32: return "float32";
        case Number::kInt32: return "int32";
        case Number::kInt64: return "int64";
        case Number::kUint8: return "uint8";
    }
    return "float64";
}

/// Headers of datasets stand together in blocks of this many bytes: who reads over a network or in a browser asks for a
/// few of these, rather than for one between each two datasets.
constexpr hsize_t kHeadersTogether = 1 << 15;

Handle without_times(hid_t property_class) {
    Handle properties = property_list(property_class);
    checked(H5Pset_obj_track_times(properties.get(), false), "property list");
    return properties;
}

void put_attribute(hid_t file, const std::string& object, const char* name, hid_t type, const Handle& space,
                   hid_t memory, const void* data) {
    const std::string what = object + "@" + name;
    const Handle attribute(
        H5Acreate_by_name(file, object.c_str(), name, type, space.get(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
        H5Aclose, what);
    checked(H5Awrite(attribute.get(), memory, data), what);
}

}  // namespace

Writer::Writer(const std::filesystem::path& file, std::string_view length_unit)
    : path_(file), length_unit_(length_unit), sink_(temporary_of(file)) {
    const std::string name = temporary_of(file).string();
    const Handle access = sink_.access();
    checked(H5Pset_meta_block_size(access.get(), kHeadersTogether), "file access");
    file_ = Handle(H5Fcreate(name.c_str(), H5F_ACC_TRUNC, without_times(H5P_FILE_CREATE).get(), access.get()), H5Fclose,
                   name);
}

Writer::~Writer() {
    if (path_.empty()) return;
    sink_.discard();
    file_ = Handle();
    std::error_code ignored;
    std::filesystem::remove(temporary_of(path_), ignored);
}

void Writer::group(const std::string& path) {
    if (groups_.contains(path)) return;
    make_parents(path);
    const Handle made(
        H5Gcreate2(file_.get(), path.c_str(), H5P_DEFAULT, without_times(H5P_GROUP_CREATE).get(), H5P_DEFAULT),
        H5Gclose, path);
    groups_.insert(path);
}

void Writer::make_parents(const std::string& path) { group(path.substr(0, path.rfind('/'))); }

void Writer::attribute(const std::string& object, const char* name, std::string_view text) {
    const std::string valid = valid_text(text);
    const std::string_view stored = cut_text(valid, kLongestAttribute);
    const Handle type = string_type(stored.size());
    // An empty text is one byte of padding: the terminator of `valid`.
    put_attribute(file_.get(), object, name, type.get(), extent(0, nullptr), type.get(), valid.c_str());
}

void Writer::attribute(const std::string& object, const char* name, double value) {
    put_attribute(file_.get(), object, name, H5T_IEEE_F64LE, extent(0, nullptr), H5T_NATIVE_DOUBLE, &value);
}

void Writer::attribute(const std::string& object, const char* name, int value) {
    put_attribute(file_.get(), object, name, H5T_STD_I32LE, extent(0, nullptr), H5T_NATIVE_INT, &value);
}

void Writer::vtk_attributes(const std::string& object) {
    constexpr std::string_view kType = "UnstructuredGrid";
    const Handle type(H5Tcopy(H5T_C_S1), H5Tclose, object);
    checked(H5Tset_size(type.get(), kType.size()), object);
    checked(H5Tset_strpad(type.get(), H5T_STR_NULLPAD), object);
    put_attribute(file_.get(), object, "Type", type.get(), extent(0, nullptr), type.get(), kType.data());
    constexpr std::array<std::int64_t, 2> kVersion{1, 0};
    constexpr hsize_t kShape = kVersion.size();
    put_attribute(file_.get(), object, "Version", H5T_STD_I64LE, extent(1, &kShape), H5T_NATIVE_INT64, kVersion.data());
}

Handle Writer::create(const names::Field& field, std::span<const hsize_t> shape, hid_t type, const char* type_name) {
    make_parents(field.path);
    const Handle space = extent(static_cast<int>(shape.size()), shape.data());
    Handle dataset(H5Dcreate2(file_.get(), field.path, type, space.get(), H5P_DEFAULT,
                              without_times(H5P_DATASET_CREATE).get(), H5P_DEFAULT),
                   H5Dclose, field.path);
    std::string units = field.units;
    if (const std::size_t at = units.find(names::kLength); at != std::string::npos)
        units.replace(at, names::kLength.size(), length_unit_);
    attribute(field.path, "units", units);
    attribute(field.path, "description", field.description);
    described_.push_back({field.path, type_name, units, field.description});
    return dataset;
}

void Writer::numbers(const names::Field& field, std::span<const hsize_t> shape, Number in_memory, Number in_file,
                     std::span<const Rows> parts) {
    const Handle dataset = create(field, shape, file_type(in_file), type_name(in_file));
    if (std::find(shape.begin(), shape.end(), hsize_t{0}) != shape.end()) return;
    std::vector<hsize_t> start(shape.size(), 0);
    std::vector<hsize_t> count(shape.begin(), shape.end());
    for (const Rows& part : parts) {
        if (part.count == 0) continue;
        if (!count.empty()) count[0] = part.count;
        const Handle source = extent(static_cast<int>(count.size()), count.data());
        const Handle target(H5Dget_space(dataset.get()), H5Sclose, field.path);
        if (!count.empty())
            checked(H5Sselect_hyperslab(target.get(), H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr),
                    field.path);
        checked(H5Dwrite(dataset.get(), memory_type(in_memory), source.get(), target.get(), H5P_DEFAULT, part.data),
                field.path);
        if (!start.empty()) start[0] += part.count;
        sink_.require_good();
    }
}

void Writer::number(const names::Field& field, double value) {
    const Rows row{&value, 1};
    numbers(field, {}, Number::kFloat64, Number::kFloat64, {&row, 1});
}

void Writer::number(const names::Field& field, std::int32_t value) {
    const Rows row{&value, 1};
    numbers(field, {}, Number::kInt32, Number::kInt32, {&row, 1});
}

namespace {

/// Texts of `width` bytes each, padded with NUL.
std::vector<char> block_of(const std::vector<std::string>& valid, std::size_t width) {
    std::vector<char> block(width * valid.size(), '\0');
    for (std::size_t i = 0; i < valid.size(); ++i) std::copy(valid[i].begin(), valid[i].end(), &block[i * width]);
    return block;
}

}  // namespace

void Writer::strings(const names::Field& field, const std::vector<std::string>& values) {
    std::vector<std::string> valid(values.size());
    std::size_t width = 1;
    for (std::size_t i = 0; i < values.size(); ++i) {
        valid[i] = valid_text(values[i]);
        width = std::max(width, valid[i].size());
    }
    const Handle type = string_type(width);
    const hsize_t count = values.size();
    const Handle dataset = create(field, {&count, 1}, type.get(), "string");
    if (count > 0)
        checked(H5Dwrite(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, block_of(valid, width).data()),
                field.path);
}

Handle Writer::begin_numbers(const names::Field& field, std::size_t rows, Number in_file) {
    const hsize_t count = rows;
    return create(field, {&count, 1}, file_type(in_file), type_name(in_file));
}

Handle Writer::begin_strings(const names::Field& field, std::size_t rows, std::size_t width) {
    const hsize_t count = rows;
    return create(field, {&count, 1}, string_type(width).get(), "string");
}

void Writer::put(const Handle& dataset, const std::string& what, std::size_t first, std::size_t count, hid_t memory,
                 const void* data) {
    if (count == 0) return;
    const hsize_t start = first, length = count;
    const Handle source = extent(1, &length);
    const Handle target(H5Dget_space(dataset.get()), H5Sclose, what);
    checked(H5Sselect_hyperslab(target.get(), H5S_SELECT_SET, &start, nullptr, &length, nullptr), what);
    checked(H5Dwrite(dataset.get(), memory, source.get(), target.get(), H5P_DEFAULT, data), what);
    sink_.require_good();
}

void Writer::put(const Handle& dataset, const std::string& what, std::size_t first, const std::vector<double>& values) {
    put(dataset, what, first, values.size(), H5T_NATIVE_DOUBLE, values.data());
}

void Writer::put(const Handle& dataset, const std::string& what, std::size_t first,
                 const std::vector<std::string>& values, std::size_t width) {
    std::vector<std::string> valid;
    for (const std::string& value : values) {
        valid.push_back(valid_text(value));
        if (valid.back().size() > width) throw Inconsistent(what + " holds a text longer than its column");
    }
    put(dataset, what, first, values.size(), string_type(width).get(), block_of(valid, width).data());
}

void Writer::text(const names::Field& field, std::string_view value) {
    const std::string valid = valid_text(value);
    const Handle type = string_type(valid.size());
    const Handle dataset = create(field, {}, type.get(), "string");
    checked(H5Dwrite(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, valid.c_str()), field.path);
}

void Writer::external_link(const std::string& path, const std::string& file) {
    make_parents(path);
    checked(H5Lcreate_external(file.c_str(), "/", file_.get(), path.c_str(), H5P_DEFAULT, H5P_DEFAULT), path);
}

void Writer::commit() {
    file_.close(temporary_of(path_).string());
    sink_.require_good();
    commit_file(path_);
    path_.clear();
}

void Writer::require_count(const names::Field& field, std::size_t count, std::size_t expected) {
    if (count != expected)
        throw Inconsistent(std::string(field.path) + " has " + std::to_string(count) +
                           " rows where the record asks for " + std::to_string(expected));
}

void Writer::require_int32(const names::Field& field, std::span<const std::int32_t> values, std::size_t components) {
    const auto bad = std::find_if(values.begin(), values.end(), [](std::int32_t v) { return v < -2; });
    if (bad != values.end())
        throw Inconsistent(
            std::string(field.path) + " holds index " + std::to_string(static_cast<std::uint32_t>(*bad)) + " in row " +
            std::to_string(static_cast<std::size_t>(bad - values.begin()) / components) +
            ", larger than the format's limit of " + std::to_string(std::numeric_limits<std::int32_t>::max()));
}

}  // namespace lumenline::hdf
