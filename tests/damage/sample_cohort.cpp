#include "tests/damage/sample_cohort.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include "io/archive/handle.h"
#include "tests/cli/process.h"

namespace lumenline::damage {

namespace {

using hdf::Handle;

Handle open_file(const std::filesystem::path& file) {
    return {H5Fopen(file.c_str(), H5F_ACC_RDWR, hdf::file_access().get()), H5Fclose, "open"};
}

herr_t copy_attribute(hid_t from, const char* name, const H5A_info_t* /*info*/, void* to) {
    const Handle source(H5Aopen(from, name, H5P_DEFAULT), H5Aclose, name);
    const Handle type(H5Aget_type(source.get()), H5Tclose, name), space(H5Aget_space(source.get()), H5Sclose, name);
    std::vector<char> value(H5Tget_size(type.get()) *
                            static_cast<std::size_t>(H5Sget_simple_extent_npoints(space.get())));
    hdf::checked(H5Aread(source.get(), type.get(), value.data()), name);
    const Handle copy(H5Acreate2(*static_cast<hid_t*>(to), name, type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT),
                      H5Aclose, name);
    return hdf::checked(H5Awrite(copy.get(), type.get(), value.data()), name);
}

std::filesystem::path computed() {
    const std::filesystem::path folder =
        std::filesystem::path(::testing::TempDir()) / ("lumenline-damage-" + std::to_string(::getpid()));
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    using cli_test::run_lumenline;
    EXPECT_EQ(
        run_lumenline({"phantom", "tree", "-o", "tree.ply", "--leaves", "2", "--length", "4", "--points-around", "8"},
                      folder)
            .status,
        0);
    cli_test::write_text(folder / "broken.ply", "ply\n");
    cli_test::write_text(folder / "models.tsv",
                         "id\tsurface\tgroup\tage\nforked\ttree.ply\ta\t63\nbroken\tbroken.ply\tb\t64\n");
    cli_test::write_text(folder / "cohort.yaml",
                         "cohort: a\nlength_unit: mm\nmodels: {table: models.tsv}\narchive: {directory: results}\n");
    EXPECT_EQ(run_lumenline({"run", "cohort.yaml"}, folder).status, 1);
    return folder / "results";
}

}  // namespace

std::filesystem::path sample_cohort() {
    struct Once {
        std::filesystem::path archive = computed();
        ~Once() { std::filesystem::remove_all(archive.parent_path()); }
    };
    static const Once once;
    const std::filesystem::path copy = cli_test::fresh_folder() / "results";
    std::filesystem::remove_all(copy);
    std::filesystem::copy(once.archive, copy, std::filesystem::copy_options::recursive);
    return copy;
}

std::filesystem::path whole_model(const std::filesystem::path& archive) {
    return archive / "models" / (std::string(kWhole) + ".hdf");
}

const char* name_of(Harm harm) {
    switch (harm) {
        case Harm::kRemoved: return "removed";
        case Harm::kShortened: return "shortened";
        case Harm::kRetyped: return "retyped";
        case Harm::kGarbled: return "garbled";
    }
    return "";
}

namespace {

/// Changes bytes of a dataset's one chunk behind the back of its checksum.
void garble_chunk(hid_t dataset, int rank, std::size_t bytes, const std::string& path) {
    const std::vector<hsize_t> origin(static_cast<std::size_t>(rank), 0);
    std::vector<char> chunk(bytes + 4);  // Fletcher's checksum behind the values
    std::uint32_t unused = 0;
    hdf::checked(H5Dread_chunk(dataset, H5P_DEFAULT, origin.data(), &unused, chunk.data()), path);
    chunk.front() = static_cast<char>(chunk.front() ^ 0x55);
    hdf::checked(H5Dwrite_chunk(dataset, H5P_DEFAULT, 0, origin.data(), chunk.size(), chunk.data()), path);
}

}  // namespace

bool harm_dataset(const std::filesystem::path& file, const std::string& path, Harm harm) {
    const Handle raw = open_file(file);
    if (harm == Harm::kRemoved) {
        hdf::checked(H5Ldelete(raw.get(), path.c_str(), H5P_DEFAULT), path);
        return true;
    }
    const Handle before(H5Dopen2(raw.get(), path.c_str(), H5P_DEFAULT), H5Dclose, path);
    const Handle type(H5Dget_type(before.get()), H5Tclose, path), space(H5Dget_space(before.get()), H5Sclose, path);
    hsize_t shape[H5S_MAX_RANK] = {};
    const int rank = H5Sget_simple_extent_dims(space.get(), shape, nullptr);
    if (harm != Harm::kRetyped && (rank == 0 || H5Sget_simple_extent_npoints(space.get()) == 0)) return false;
    if (harm == Harm::kShortened) --shape[0];
    const bool is_text = H5Tget_class(type.get()) == H5T_STRING;
    const Handle other(
        harm != Harm::kRetyped ? H5Tcopy(type.get()) : H5Tcopy(is_text ? H5T_STD_I32LE : hdf::string_type(4).get()),
        H5Tclose, path);
    const Handle extent = hdf::extent(rank, shape), properties = hdf::property_list(H5P_DATASET_CREATE);
    if (harm == Harm::kGarbled) {
        hdf::checked(H5Pset_chunk(properties.get(), rank, shape), path);
        hdf::checked(H5Pset_fletcher32(properties.get()), path);
    }
    const Handle after(
        H5Dcreate2(raw.get(), "/damaged", other.get(), extent.get(), H5P_DEFAULT, properties.get(), H5P_DEFAULT),
        H5Dclose, path);
    if (harm != Harm::kRetyped) {
        std::vector<char> values(H5Tget_size(type.get()) *
                                 static_cast<std::size_t>(H5Sget_simple_extent_npoints(space.get())));
        hdf::checked(H5Dread(before.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), path);
        hdf::checked(H5Dwrite(after.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), path);
        hdf::checked(H5Dflush(after.get()), path);
        if (harm == Harm::kGarbled) garble_chunk(after.get(), rank, values.size(), path);
    }
    hid_t target = after.get();
    hsize_t position = 0;
    hdf::checked(H5Aiterate2(before.get(), H5_INDEX_NAME, H5_ITER_INC, &position, copy_attribute, &target), path);
    hdf::checked(H5Ldelete(raw.get(), path.c_str(), H5P_DEFAULT), path);
    hdf::checked(H5Lmove(raw.get(), "/damaged", raw.get(), path.c_str(), H5P_DEFAULT, H5P_DEFAULT), path);
    return true;
}

void change_numbers(const std::filesystem::path& file, const std::string& path,
                    const std::function<void(std::vector<double>&)>& change) {
    const Handle raw = open_file(file);
    const Handle dataset(H5Dopen2(raw.get(), path.c_str(), H5P_DEFAULT), H5Dclose, path);
    const Handle space(H5Dget_space(dataset.get()), H5Sclose, path);
    std::vector<double> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space.get())));
    hdf::checked(H5Dread(dataset.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), path);
    change(values);
    hdf::checked(H5Dwrite(dataset.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), path);
}

void copy_dataset(const std::filesystem::path& file, const std::string& from, const std::string& to) {
    const Handle raw = open_file(file);
    hdf::checked(H5Ocopy(raw.get(), from.c_str(), raw.get(), to.c_str(), H5P_DEFAULT, H5P_DEFAULT), to);
}

void set_attribute(const std::filesystem::path& file, const std::string& object, const std::string& name,
                   const std::string& text) {
    const Handle raw = open_file(file);
    hdf::checked(H5Adelete_by_name(raw.get(), object.c_str(), name.c_str(), H5P_DEFAULT), name);
    const Handle type = hdf::string_type(text.size());
    const Handle attribute(H5Acreate_by_name(raw.get(), object.c_str(), name.c_str(), type.get(),
                                             hdf::extent(0, nullptr).get(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                           H5Aclose, name);
    hdf::checked(H5Awrite(attribute.get(), type.get(), text.c_str()), name);
}

}  // namespace lumenline::damage
