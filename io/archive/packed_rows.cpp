#include "io/archive/packed_rows.h"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstring>
#include <string>
#include <type_traits>

#include "io/archive/tables.h"

namespace lumenline::hdf {

namespace {

static_assert(std::endian::native == std::endian::little, "the bytes are those of memory");

std::uint32_t checksum(const std::vector<Table>& tables, std::string_view content) {
    std::string columns;
    for (const Table& table : tables) {
        columns.append(table.name).push_back('\0');
        for (const Column& column : table.columns)
            columns.append(column.name).push_back(static_cast<char>(1 + static_cast<int>(column.kind)));
    }
    uLong sum = 0;
    for (const std::string_view part : {std::string_view(columns), content})
        sum = crc32_z(sum, reinterpret_cast<const Bytef*>(part.data()), part.size());
    return static_cast<std::uint32_t>(sum);
}

template <class T>
void append(std::vector<std::uint8_t>& bytes, const T* values, std::size_t count) {
    static_assert(std::is_trivially_copyable_v<T>);
    const auto* first = reinterpret_cast<const std::uint8_t*>(values);
    bytes.insert(bytes.end(), first, first + count * sizeof(T));
}

void append_length(std::vector<std::uint8_t>& bytes, std::size_t length) {
    const auto value = static_cast<std::uint32_t>(length);
    append(bytes, &value, 1);
}

/// Takes values from the front of bytes, as long as there are enough.
class Unpacker {
public:
    explicit Unpacker(std::string_view bytes) : left_(bytes) {}

    [[nodiscard]] bool has(std::size_t count, std::size_t size) const { return count <= left_.size() / size; }
    [[nodiscard]] std::string_view rest() const { return left_; }

    template <class T>
    void take(T* values, std::size_t count) {
        if (count > 0) std::memcpy(values, left_.data(), count * sizeof(T));
        left_.remove_prefix(count * sizeof(T));
    }

    bool take_length(std::uint32_t& length) {
        if (!has(1, sizeof(length))) return false;
        take(&length, 1);
        return true;
    }

    bool take_text(std::string& text) {
        std::uint32_t length = 0;
        if (!take_length(length) || !has(length, 1)) return false;
        text.assign(left_.substr(0, length));
        left_.remove_prefix(length);
        return true;
    }

private:
    std::string_view left_;
};

bool take_column(Unpacker& from, std::size_t rows, Column& column) {
    if (column.kind != ColumnKind::kText) {
        if (!from.has(rows, sizeof(double))) return false;
        column.numbers.resize(rows);
        from.take(column.numbers.data(), rows);
        return column.kind == ColumnKind::kNumber ||
               std::all_of(column.numbers.begin(), column.numbers.end(), is_index);
    }
    if (!from.has(rows, sizeof(std::uint32_t))) return false;
    column.texts.resize(rows);
    for (std::string& text : column.texts)
        if (!from.take_text(text)) return false;
    return true;
}

}  // namespace

std::vector<std::uint8_t> pack_rows(const std::vector<Table>& tables) {
    std::vector<std::uint8_t> bytes;
    append_length(bytes, 0);
    for (const Table& table : tables) append_length(bytes, table.rows());
    for (const Table& table : tables)
        for (const Column& column : table.columns) {
            append(bytes, column.numbers.data(), column.numbers.size());
            for (const std::string& text : column.texts) {
                append_length(bytes, text.size());
                append(bytes, text.data(), text.size());
            }
        }
    const std::string_view all(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const std::uint32_t sum = checksum(tables, all.substr(sizeof(std::uint32_t)));
    std::memcpy(bytes.data(), &sum, sizeof(sum));
    return bytes;
}

bool unpack_rows(std::string_view bytes, std::vector<Table>& tables) {
    Unpacker from(bytes);
    std::uint32_t sum = 0;
    if (!from.take_length(sum) || sum != checksum(tables, from.rest())) return false;
    std::vector<std::uint32_t> rows(tables.size());
    for (std::uint32_t& count : rows)
        if (!from.take_length(count)) return false;
    for (std::size_t t = 0; t < tables.size(); ++t)
        for (Column& column : tables[t].columns)
            if (!take_column(from, rows[t], column)) return false;
    return from.rest().empty();
}

}  // namespace lumenline::hdf
