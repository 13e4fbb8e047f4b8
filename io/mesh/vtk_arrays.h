#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "io/mesh/scalars.h"
#include "io/mesh/vtk_cells.h"

namespace lumenline::mesh {

/// Arrays of a legacy VTK file, read at a cursor that its owner shares.
class LegacyArrays {
public:
    LegacyArrays(const SourceFile& file, Cursor& cursor, ScalarReader& reader)
        : file_(file), cursor_(cursor), reader_(reader) {}

    /// Next token as the type of numbers.
    ScalarType parse_type();
    /// Leaves the header line of an array.
    void begin_array();
    /// Passes over a block METADATA, whose keyword was taken.
    void skip_metadata();
    /// Reads the arrays of a section FIELD, whose keyword was taken; where `cells` is not null, those with one
    /// value for each cell are added to it.
    void parse_field(VtkCells* cells);
    /// Reads the sections POINT_DATA and CELL_DATA up to the end of the file; the keyword of the first, `section`
    /// (empty if there is none), was taken. Arrays of one value per cell are added to `cells`. What cannot be read is
    /// reported there, with the arrays behind it: the surface is complete without them.
    void parse_attributes(std::string_view section, VtkCells& cells);

private:
    struct ArrayType {
        enum class Kind { kNumbers, kBits, kStrings } kind;
        ScalarType scalar;
    };

    void parse_section(std::string_view section, VtkCells& cells);
    void parse_attribute(std::string_view kind, std::uint64_t tuples, VtkCells* cells);
    void parse_scalars(std::uint64_t tuples, VtkCells* cells);
    ArrayType parse_array_type();
    void parse_values(const std::string& name, ArrayType type, std::uint64_t components, std::uint64_t tuples,
                      VtkCells* cells);
    std::string parse_name();
    std::uint64_t parse_components();
    void skip_colours(std::uint64_t numbers);
    void skip_strings(std::uint64_t count);

    const SourceFile& file_;
    Cursor& cursor_;
    ScalarReader& reader_;
};

}  // namespace lumenline::mesh
