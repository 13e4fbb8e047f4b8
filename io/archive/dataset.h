#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "io/archive/handle.h"

namespace lumenline::hdf {

/// A dataset or an attribute of a file that is not trusted, opened for reading.
class Values {
public:
    /// @throws Error if there is no such dataset
    static Values dataset(hid_t file, const std::string& path);
    /// @throws Error if there is no such attribute
    static Values attribute(hid_t file, const std::string& object, const std::string& name);

    [[nodiscard]] const std::vector<std::uint64_t>& shape() const { return shape_; }
    /// "float64", "int32", "uint8", "string"; "other" for what we do not read.
    [[nodiscard]] const std::string& type() const { return type_; }
    [[nodiscard]] bool is_text() const { return type_ == "string"; }
    /// Number of values, and of values per index of the first dimension (1 for rank 0 and 1).
    [[nodiscard]] std::size_t count() const { return rows() * row_length(); }
    [[nodiscard]] std::size_t rows() const { return shape_.empty() ? 1 : shape_.front(); }
    [[nodiscard]] std::size_t row_length() const;

    /// Throws Error if the values cannot all stand in a file of `file_bytes` bytes.
    void require_within(std::uintmax_t file_bytes) const;
    /// Throws Error if the values of a contiguous dataset stand beyond `end` [bytes], that of the file.
    void require_stored(std::uintmax_t end) const;

    /// Values of rows [first, first + count) (all of an attribute). Numbers only.
    [[nodiscard]] std::vector<double> numbers(std::size_t first, std::size_t count) const;
    /// Values as text: text as it stands, numbers as the shortest text that reads back the same.
    [[nodiscard]] std::vector<std::string> texts(std::size_t first, std::size_t count) const;
    /// The same in the bytes of the file's type, little-endian, one after the other. Numbers only.
    [[nodiscard]] std::string bytes(std::size_t first, std::size_t count) const;

private:
    Values(Handle object, bool is_attribute, std::string name);

    void read(hid_t memory_type, std::size_t first, std::size_t count, void* target) const;
    template <class T>
    [[nodiscard]] std::vector<T> read_as(hid_t memory_type, std::size_t first, std::size_t count) const;
    [[nodiscard]] std::vector<std::string> strings(std::size_t first, std::size_t count) const;
    [[nodiscard]] std::vector<std::string> variable_strings(std::size_t first, std::size_t count) const;

    Handle object_;
    Handle stored_type_;
    bool is_attribute_ = false;
    std::string name_;
    std::string type_;
    std::vector<std::uint64_t> shape_;
};

}  // namespace lumenline::hdf
