// The index is copied as a file; then each link to a model gives way to the model itself: H5Ocopy copies a group with
// all that it holds and its attributes, byte for byte, without decoding anything.
#include "io/archive/pack.h"

#include <string>
#include <system_error>
#include <vector>

#include "io/archive/commit.h"
#include "io/archive/handle.h"
#include "io/archive/index_names.h"
#include "io/archive/model_file.h"
#include "io/archive/read.h"
#include "io/archive/utf8.h"

namespace lumenline {

namespace {

hdf::Handle open_file(const std::filesystem::path& file, unsigned flags) {
    return {H5Fopen(file.c_str(), flags, hdf::file_access().get()), H5Fclose, "no complete HDF5 file"};
}

class Packing {
public:
    Packing(const std::filesystem::path& index, const std::filesystem::path& target) : index_(index), target_(target) {}

    Packed run(const std::function<void(std::size_t, std::size_t)>& progress) {
        const ArchiveFile about(index_);
        if (about.format() != names::kCohortFormat || about.attribute("/", names::kPackedAttribute))
            throw UnknownName("'" + index_.string() + "' is one file already: there is nothing to pack");
        const std::filesystem::path temporary = temporary_of(target_);
        try {
            std::filesystem::copy_file(index_, temporary, std::filesystem::copy_options::overwrite_existing);
            fill(about.strings(names::kId.path), open_file(temporary, H5F_ACC_RDWR), progress);
            commit_file(target_);
        } catch (...) {
            std::error_code ignored;
            std::filesystem::remove(temporary, ignored);
            throw;
        }
        return result_;
    }

private:
    void fill(const std::vector<std::string>& ids, hdf::Handle packed,
              const std::function<void(std::size_t, std::size_t)>& progress) {
        {
            const hdf::Handle scalar = hdf::extent(0, nullptr);
            const hdf::Handle mark(H5Acreate2(packed.get(), names::kPackedAttribute, H5T_STD_I32LE, scalar.get(),
                                              H5P_DEFAULT, H5P_DEFAULT),
                                   H5Aclose, names::kPackedAttribute);
            const int yes = 1;
            hdf::checked(H5Awrite(mark.get(), H5T_NATIVE_INT, &yes), names::kPackedAttribute);
        }
        for (std::size_t i = 0; i < ids.size(); ++i) {
            add_model(ids[i], packed);
            if (progress) progress(i + 1, ids.size());
        }
        packed.close("cannot write '" + temporary_of(target_).string() + "'");
    }

    void add_model(const std::string& id, const hdf::Handle& packed) {
        if (id.empty() || id == "." || id.find('/') != std::string::npos)
            throw hdf::Error("it names a model '" + printable(id) + "', which is no file name");
        const std::string place = std::string(names::kModelLinks) + "/" + id;
        if (hdf::checked(H5Lexists(packed.get(), place.c_str(), H5P_DEFAULT), place) > 0)
            hdf::checked(H5Ldelete(packed.get(), place.c_str(), H5P_DEFAULT), place);
        const std::filesystem::path file = model_path(index_.parent_path(), id);
        std::error_code error;
        if (!std::filesystem::exists(file, error)) {
            ++result_.missing;
            return;
        }
        const ArchiveFile checked(file);  // complete, ours, and of this format
        checked.require_copyable();
        const hdf::Handle source = open_file(file, H5F_ACC_RDONLY);
        hdf::checked(H5Ocopy(source.get(), "/", packed.get(), place.c_str(), H5P_DEFAULT, H5P_DEFAULT),
                     "copying '" + file.string() + "'");
        ++result_.models;
    }

    std::filesystem::path index_, target_;
    Packed result_;
};

}  // namespace

Packed pack_archive(const std::filesystem::path& archive, const std::filesystem::path& file,
                    const std::function<void(std::size_t, std::size_t)>& progress) {
    const hdf::Quiet quiet;
    const std::filesystem::path index = index_or_file(archive);
    try {
        refuse_overwriting(file, archive);
        return Packing(index, output_file(file)).run(progress);
    } catch (const hdf::Error& error) {
        throw ArchiveError("cannot pack '" + index.string() + "': " + printable(error.what()));
    } catch (const std::system_error& error) {
        throw ArchiveError("cannot write '" + file.string() + "': " + error.what());
    }
}

}  // namespace lumenline
