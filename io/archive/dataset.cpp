// A damaged or hostile file may claim any extent and any type. Types are sorted out once, when the
// object is opened, and an extent is believed only if its values fit into the file (contiguous data)
// before memory is asked for.

#include "io/archive/dataset.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>

#include "engine/core/text.h"

namespace lumenline::hdf {

namespace {

std::string type_text(hid_t type) {
    const std::size_t bytes = H5Tget_size(type);
    const std::string bits = std::to_string(8 * bytes);
    switch (H5Tget_class(type)) {
        case H5T_FLOAT: return bytes == 4 || bytes == 8 ? "float" + bits : "other";
        case H5T_INTEGER: return bytes > 8 ? "other" : (H5Tget_sign(type) == H5T_SGN_NONE ? "uint" : "int") + bits;
        case H5T_STRING: return "string";
        default: return "other";
    }
}

std::string float_text(float value) {
    std::array<char, 32> buffer{};
    const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
    return {buffer.data(), result.ptr};
}

template <class T, class Text>
std::vector<std::string> all_texts(const std::vector<T>& values, Text text) {
    std::vector<std::string> texts;
    texts.reserve(values.size());
    for (const T value : values) texts.push_back(text(value));
    return texts;
}

}  // namespace

Values Values::dataset(hid_t file, const std::string& path) {
    const std::string name = path.substr(path.starts_with("./") ? 1 : 0);
    return {Handle(H5Dopen2(file, path.c_str(), H5P_DEFAULT), H5Dclose, name), false, name};
}

Values Values::attribute(hid_t file, const std::string& object, const std::string& name) {
    const std::string what = object + "@" + name;
    return {Handle(H5Aopen_by_name(file, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose, what), true,
            what};
}

Values::Values(Handle object, bool is_attribute, std::string name)
    : object_(std::move(object)), is_attribute_(is_attribute), name_(std::move(name)) {
    const hid_t id = object_.get();
    stored_type_ = Handle(is_attribute ? H5Aget_type(id) : H5Dget_type(id), H5Tclose, name_);
    type_ = type_text(stored_type_.get());
    const Handle space(is_attribute ? H5Aget_space(id) : H5Dget_space(id), H5Sclose, name_);
    if (H5Sget_simple_extent_type(space.get()) == H5S_NULL) {
        shape_ = {0};
        return;
    }
    std::array<hsize_t, H5S_MAX_RANK> dims{};
    const int rank = checked(H5Sget_simple_extent_dims(space.get(), dims.data(), nullptr), name_);
    shape_.assign(dims.begin(), dims.begin() + rank);
}

std::size_t Values::row_length() const {
    std::size_t length = 1;
    for (std::size_t i = 1; i < shape_.size(); ++i) length *= shape_[i];
    return length;
}

void Values::require_within(std::uintmax_t file_bytes) const {
    if (is_attribute_) return;
    const Handle creation(H5Dget_create_plist(object_.get()), H5Pclose, name_);
    if (H5Pget_layout(creation.get()) == H5D_CHUNKED) file_bytes *= 1032;  // the most that deflate can gain
    std::uintmax_t left = file_bytes / std::max<std::size_t>(H5Tget_size(stored_type_.get()), 1);
    for (const std::uint64_t length : shape_) {
        if (length == 0) return;
        left /= length;
    }
    if (left == 0)
        throw Error(name_ + ": its values do not fit into the file of " + std::to_string(file_bytes) + " bytes");
}

void Values::require_stored(std::uintmax_t end) const {
    const haddr_t offset = H5Dget_offset(object_.get());  // undefined for values in chunks
    if (offset == HADDR_UNDEF) return;
    if (offset > end || H5Dget_storage_size(object_.get()) > end - offset)
        throw Error(name_ + ": its values lie beyond the end of the file");
}

void Values::read(hid_t memory_type, std::size_t first, std::size_t count, void* target) const {
    if (is_attribute_) {
        checked(H5Aread(object_.get(), memory_type, target), name_);
        return;
    }
    std::vector<hsize_t> start(shape_.size(), 0);
    std::vector<hsize_t> extents(shape_.begin(), shape_.end());
    const Handle file_space(H5Dget_space(object_.get()), H5Sclose, name_);
    if (!shape_.empty()) {
        start[0] = first;
        extents[0] = count;
        checked(H5Sselect_hyperslab(file_space.get(), H5S_SELECT_SET, start.data(), nullptr, extents.data(), nullptr),
                name_);
    }
    const Handle memory_space = extent(static_cast<int>(extents.size()), extents.data());
    checked(H5Dread(object_.get(), memory_type, memory_space.get(), file_space.get(), H5P_DEFAULT, target), name_);
}

template <class T>
std::vector<T> Values::read_as(hid_t memory_type, std::size_t first, std::size_t count) const {
    std::vector<T> values(count * row_length());
    if (!values.empty()) read(memory_type, first, count, values.data());
    return values;
}

std::vector<double> Values::numbers(std::size_t first, std::size_t count) const {
    if (is_text() || type_ == "other") throw Error(name_ + ": holds no numbers but " + type_);
    return read_as<double>(H5T_NATIVE_DOUBLE, first, count);
}

std::string Values::bytes(std::size_t first, std::size_t count) const {
    if (is_text() || type_ == "other") throw Error(name_ + ": holds no numbers but " + type_);
    const Handle ordered(H5Tcopy(stored_type_.get()), H5Tclose, name_);
    checked(H5Tset_order(ordered.get(), H5T_ORDER_LE), name_);
    std::string block(count * row_length() * H5Tget_size(ordered.get()), '\0');
    if (!block.empty()) read(ordered.get(), first, count, block.data());
    return block;
}

std::vector<std::string> Values::strings(std::size_t first, std::size_t count) const {
    if (checked(H5Tis_variable_str(stored_type_.get()), name_) > 0) return variable_strings(first, count);
    const std::size_t width = H5Tget_size(stored_type_.get());
    std::vector<char> block(count * row_length() * width);
    // In the file's own type, so that nothing is cut or converted.
    if (!block.empty()) read(stored_type_.get(), first, count, block.data());
    const bool spaces = H5Tget_strpad(stored_type_.get()) == H5T_STR_SPACEPAD;
    std::vector<std::string> texts;
    for (std::size_t i = 0; i < block.size(); i += width) {
        std::string text(&block[i], strnlen(&block[i], width));
        if (spaces) text.erase(text.find_last_not_of(' ') + 1);
        texts.push_back(std::move(text));
    }
    return texts;
}

std::vector<std::string> Values::variable_strings(std::size_t first, std::size_t count) const {
    const std::size_t size = count * row_length();
    if (size == 0) return {};
    std::vector<char*> pointers(size, nullptr);
    read(stored_type_.get(), first, count, pointers.data());
    std::vector<std::string> texts;
    texts.reserve(size);
    for (char* pointer : pointers) {
        texts.emplace_back(pointer == nullptr ? "" : pointer);
        H5free_memory(pointer);
    }
    return texts;
}

std::vector<std::string> Values::texts(std::size_t first, std::size_t count) const {
    if (is_text()) return strings(first, count);
    if (type_ == "float32") return all_texts(read_as<float>(H5T_NATIVE_FLOAT, first, count), float_text);
    if (type_ == "float64") return all_texts(read_as<double>(H5T_NATIVE_DOUBLE, first, count), exact_text);
    const auto integer = [](auto value) { return std::to_string(value); };
    if (type_.starts_with("uint")) return all_texts(read_as<std::uint64_t>(H5T_NATIVE_UINT64, first, count), integer);
    if (type_.starts_with("int")) return all_texts(read_as<std::int64_t>(H5T_NATIVE_INT64, first, count), integer);
    throw Error(name_ + ": holds values of a type that this program does not show");
}

}  // namespace lumenline::hdf
