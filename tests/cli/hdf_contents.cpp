// Reads with the C library alone, so that nothing of the reader under test takes part. Values are read in the
// type of the file: what is compared is what stands there, bit by bit.
#include "tests/cli/hdf_contents.h"

#include <hdf5.h>

#include <algorithm>
#include <functional>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace lumenline::cli_test {

namespace {

class Id {
public:
    Id(hid_t id, herr_t (*close)(hid_t), const std::string& what) : id_(id), close_(close) {
        if (id < 0) throw std::runtime_error("HDF5 cannot open " + what);
    }
    ~Id() { close_(id_); }
    Id(const Id&) = delete;
    Id& operator=(const Id&) = delete;
    operator hid_t() const { return id_; }

private:
    hid_t id_;
    herr_t (*close_)(hid_t);
};

void require(herr_t result, const std::string& what) {
    if (result < 0) throw std::runtime_error("HDF5 cannot read " + what);
}

/// "class size sign shape:" of a value.
std::string header_of(hid_t type, hid_t space, std::size_t& bytes) {
    const int rank = H5Sget_simple_extent_ndims(space);
    std::vector<hsize_t> shape(static_cast<std::size_t>(rank < 0 ? 0 : rank));
    if (rank > 0) H5Sget_simple_extent_dims(space, shape.data(), nullptr);
    bytes = static_cast<std::size_t>(std::accumulate(shape.begin(), shape.end(), hsize_t{1}, std::multiplies<>())) *
            H5Tget_size(type);
    std::string text = std::to_string(H5Tget_class(type)) + " " + std::to_string(H5Tget_size(type)) + " (";
    for (const hsize_t n : shape) text += std::to_string(n) + ",";
    return text + "): ";
}

/// Bytes of a value that `read(buffer)` fills; texts of variable length are followed.
template <class Read>
std::string value_of(hid_t type, hid_t space, const std::string& name, const Read& read) {
    std::size_t bytes = 0;
    const std::string header = header_of(type, space, bytes);
    if (H5Tis_variable_str(type) > 0) {
        std::vector<char*> texts(bytes / sizeof(char*), nullptr);
        require(read(texts.data()), name);
        std::string all = header;
        for (const char* text : texts) all += std::string(text == nullptr ? "" : text) + '\0';
        H5Dvlen_reclaim(type, space, H5P_DEFAULT, texts.data());
        return all;
    }
    std::string buffer(bytes, '\0');
    if (bytes > 0) require(read(buffer.data()), name);
    return header + buffer;
}

struct Visit {
    std::map<std::string, std::string> found;
    const std::vector<std::string>* without;
    std::string object;  // whose attributes are being read
    std::string error;   // exceptions must not cross the C library
};

bool left_out(const Visit& visit, const std::string& name) {
    for (const std::string& root : *visit.without)
        if (name == root || name.starts_with(root + "/") || name.starts_with(root + "@")) return true;
    return false;
}

herr_t add_attribute(hid_t object, const char* name, const H5A_info_t*, void* data) {
    Visit& visit = *static_cast<Visit*>(data);
    const std::string full = visit.object + "@" + name;
    try {
        const Id attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose, full);
        const Id type(H5Aget_type(attribute), H5Tclose, full), space(H5Aget_space(attribute), H5Sclose, full);
        visit.found[full] = value_of(type, space, full, [&](void* to) { return H5Aread(attribute, type, to); });
        return 0;
    } catch (const std::exception& error) {
        visit.error = error.what();
        return -1;
    }
}

void add_object(hid_t file, const std::string& name, Visit& visit) {
    const Id object(H5Oopen(file, name.c_str(), H5P_DEFAULT), H5Oclose, name);
    if (H5Iget_type(object) == H5I_DATASET) {
        const Id type(H5Dget_type(object), H5Tclose, name), space(H5Dget_space(object), H5Sclose, name);
        visit.found[name] = value_of(
            type, space, name, [&](void* to) { return H5Dread(object, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, to); });
    } else {
        visit.found[name] = "group";
    }
    visit.object = name;
    require(H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_INC, nullptr, add_attribute, &visit), "attributes of " + name);
}

herr_t add_link(hid_t file, const char* relative, const H5L_info_t* info, void* data) {
    Visit& visit = *static_cast<Visit*>(data);
    const std::string name = std::string("/") + relative;
    if (left_out(visit, name)) return 0;
    try {
        if (info->type == H5L_TYPE_HARD) {
            add_object(file, name, visit);
        } else {
            std::string target(info->u.val_size, '\0');
            require(H5Lget_val(file, relative, target.data(), target.size(), H5P_DEFAULT), name);
            visit.found[name] = "link " + target;
        }
        return 0;
    } catch (const std::exception& error) {
        visit.error = error.what();
        return -1;
    }
}

}  // namespace

std::map<std::string, std::string> hdf_contents(const std::filesystem::path& path,
                                                const std::vector<std::string>& without) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    const Id file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose, path.string());
    Visit visit;
    visit.without = &without;
    add_object(file, "/", visit);
    if (H5Lvisit(file, H5_INDEX_NAME, H5_ITER_INC, add_link, &visit) < 0)
        throw std::runtime_error(path.string() + ": " + visit.error);
    return std::move(visit.found);
}

std::vector<std::filesystem::path> hdf_files(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files;
    std::error_code none_yet;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder, none_yet))
        if (const auto extension = entry.path().extension(); extension == ".hdf" || extension == ".h5")
            files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

std::map<std::string, std::string> archive_contents(const std::filesystem::path& folder) {
    std::map<std::string, std::string> all;
    for (const auto& file : hdf_files(folder))
        for (auto& [name, value] : hdf_contents(file))
            all[std::filesystem::relative(file, folder).string() + name] = std::move(value);
    return all;
}

std::vector<std::string> differences(const std::map<std::string, std::string>& a,
                                     const std::map<std::string, std::string>& b) {
    std::vector<std::string> names;
    for (const auto& [name, value] : a)
        if (const auto other = b.find(name); other == b.end() || other->second != value) names.push_back(name);
    for (const auto& [name, value] : b)
        if (!a.contains(name)) names.push_back(name);
    return names;
}

}  // namespace lumenline::cli_test
