// Typed numbers of PLY and VTK files. Every number is checked against the end of the file when it is
// read, because list lengths inside the data can be as wrong as the counts of the header.

#include "io/mesh/scalars.h"

#include <cmath>
#include <string>

#include "engine/core/text.h"

namespace lumenline::mesh {
namespace {

double load_number(const char* bytes, ScalarType type, Encoding encoding) {
    switch (type) {
        case ScalarType::kInt8: return load<std::int8_t>(bytes, encoding);
        case ScalarType::kUint8: return load<std::uint8_t>(bytes, encoding);
        case ScalarType::kInt16: return load<std::int16_t>(bytes, encoding);
        case ScalarType::kUint16: return load<std::uint16_t>(bytes, encoding);
        case ScalarType::kInt32: return load<std::int32_t>(bytes, encoding);
        case ScalarType::kUint32: return load<std::uint32_t>(bytes, encoding);
        case ScalarType::kInt64: return static_cast<double>(load<std::int64_t>(bytes, encoding));
        case ScalarType::kUint64: return static_cast<double>(load<std::uint64_t>(bytes, encoding));
        case ScalarType::kFloat32: return load<float>(bytes, encoding);
        case ScalarType::kFloat64: return load<double>(bytes, encoding);
    }
    return 0;
}

}  // namespace

const char* ScalarReader::take(std::size_t size, std::string_view noun) {
    last_ = cursor_.position();
    if (cursor_.remaining() < size) {
        fail_at(file_, last_, ErrorCode::kFileFormat,
                "expected " + std::string(noun) + " of " + counted(size, "byte") + ", found " + std::string(file_.end) +
                    " " + counted(cursor_.remaining(), "byte") + " later");
    }
    cursor_.move_to(last_ + size);
    return file_.bytes.data() + last_;
}

double ScalarReader::coordinate(ScalarType type) {
    if (encoding_ == Encoding::kText) {
        const double value = cursor_.coordinate();
        last_ = cursor_.position();
        return value;
    }
    const double value = load_number(take(scalar_size(type), "a coordinate"), type, encoding_);
    if (!std::isfinite(value)) {
        fail_at(file_, last_, ErrorCode::kBadCoordinate, "expected a finite coordinate, found " + short_text(value));
    }
    return value;
}

double ScalarReader::number(ScalarType type) {
    if (encoding_ == Encoding::kText) {
        cursor_.peek();
        last_ = cursor_.position();
        return cursor_.number();
    }
    return load_number(take(scalar_size(type), "a number"), type, encoding_);
}

std::int64_t ScalarReader::integer(ScalarType type, std::string_view noun) {
    if (encoding_ == Encoding::kText) {
        cursor_.peek();
        last_ = cursor_.position();
        return cursor_.integer(noun);
    }
    const double value = load_number(take(scalar_size(type), noun), type, encoding_);
    // Beyond 2^53 a double skips integers; no count or index of a readable file comes near.
    constexpr double kExact = 9007199254740992.0;
    if (!(std::fabs(value) <= kExact) || value != std::trunc(value)) {
        fail_at(file_, last_, ErrorCode::kFileFormat, "expected " + std::string(noun) + ", found " + short_text(value));
    }
    return static_cast<std::int64_t>(value);
}

std::uint32_t ScalarReader::index(ScalarType type, std::uint64_t limit) {
    const std::int64_t value = integer(type, "a point index");
    if (value < 0 || static_cast<std::uint64_t>(value) >= limit) {
        fail_at(file_, last_, ErrorCode::kFileFormat,
                "expected a point index from 0 to below the number of points, " + std::to_string(limit) + ", found " +
                    std::to_string(value));
    }
    return static_cast<std::uint32_t>(value);
}

void ScalarReader::skip(ScalarType type, std::uint64_t count) {
    if (count > cursor_.remaining() / scalar_size(encoding_ == Encoding::kText ? ScalarType::kInt8 : type)) {
        fail_at(file_, cursor_.position(), ErrorCode::kFileFormat,
                "expected " + std::to_string(count) + " more numbers, found only " +
                    counted(cursor_.remaining(), "byte") + " up to " + std::string(file_.end));
    }
    if (encoding_ != Encoding::kText) {
        cursor_.move_to(cursor_.position() + static_cast<std::size_t>(count) * scalar_size(type));
        return;
    }
    for (std::uint64_t i = 0; i < count; ++i) {
        if (cursor_.token().empty()) cursor_.fail_expected(cursor_.position(), "a number");
    }
}

}  // namespace lumenline::mesh
