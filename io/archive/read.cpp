// HDF5's own calls fail with messages that name functions, not files, so every public function
// wraps what it does: an hdf::Error leaves as an ArchiveError with the file in front.

#include "io/archive/read.h"

#include <algorithm>
#include <new>
#include <ostream>

#include "io/archive/dataset.h"
#include "io/archive/names.h"
#include "io/archive/npy.h"
#include "io/archive/utf8.h"

namespace lumenline {

namespace {

using hdf::Values;

/// Values that are read and printed at a time.
constexpr std::size_t kBlock = 65536;

struct Collected {
    std::vector<std::pair<std::string, H5O_type_t>> objects;
    bool out_of_memory = false;
};

// C++ exceptions must not pass through HDF5's C frames.
herr_t collect_object(hid_t /*root*/, const char* name, const H5O_info_t* info, void* data) {
    auto* collected = static_cast<Collected*>(data);
    try {
        collected->objects.emplace_back(name, info->type);
    } catch (const std::bad_alloc&) {
        collected->out_of_memory = true;
        return -1;
    }
    return 0;
}

herr_t collect_name(hid_t /*object*/, const char* name, const H5A_info_t* /*info*/, void* data) {
    try {
        static_cast<std::vector<std::string>*>(data)->emplace_back(name);
    } catch (const std::bad_alloc&) {
        return -1;
    }
    return 0;
}

std::string joined(const std::vector<std::string>& texts, const char* separator) {
    std::string line;
    for (std::size_t i = 0; i < texts.size(); ++i) line.append(i == 0 ? "" : separator).append(texts[i]);
    return line;
}

void print_values(const Values& values, std::ostream& out) {
    const std::size_t row_length = values.row_length();
    const std::size_t step = std::max<std::size_t>(1, kBlock / std::max<std::size_t>(1, row_length));
    for (std::size_t first = 0; first < values.rows(); first += step) {
        const std::size_t rows = std::min(step, values.rows() - first);
        const std::vector<std::string> texts = values.texts(first, rows);
        std::string block;
        for (std::size_t i = 0; i < texts.size(); ++i) {
            block.append(values.is_text() ? printable(texts[i]) : texts[i]);
            block.push_back((i + 1) % row_length == 0 ? '\n' : '\t');
        }
        out << block;
    }
}

}  // namespace

struct ArchiveFile::Impl {
    std::filesystem::path path;
    std::uintmax_t bytes = 0;
    hdf::Handle file;
    hdf::Handle root;  // of the file, or a model of a packed archive
    std::string format;

    /// Paths from the root, "/surface", as HDF5 wants them from a group.
    static std::string from_root(const std::string& path) { return "." + path; }

    template <class Body>
    auto guarded(Body body) const {
        const hdf::Quiet quiet;
        try {
            return body();
        } catch (const hdf::Error& error) {
            throw ArchiveError("cannot read '" + path.string() + "': " + printable(error.what()));
        } catch (const std::bad_alloc&) {
            throw ArchiveError("cannot read '" + path.string() + "': there is not enough memory for its data");
        } catch (const std::length_error&) {
            throw ArchiveError("cannot read '" + path.string() + "': it claims more data than memory can hold");
        }
    }

    /// Is there a dataset of that path in this file? What a link to another file leads to is none of it.
    [[nodiscard]] bool is_dataset(const std::string& dataset) const {
        for (std::size_t end = dataset.find('/', 1);; end = dataset.find('/', end + 1)) {
            const std::string part = from_root(dataset.substr(0, end));
            H5L_info_t link{};
            if (H5Lexists(root.get(), part.c_str(), H5P_DEFAULT) <= 0 ||
                H5Lget_info(root.get(), part.c_str(), &link, H5P_DEFAULT) < 0 || link.type != H5L_TYPE_HARD)
                return false;
            if (end == std::string::npos) break;
        }
        H5O_info_t info{};
        return H5Oget_info_by_name2(root.get(), from_root(dataset).c_str(), &info, H5O_INFO_BASIC, H5P_DEFAULT) >= 0 &&
               info.type == H5O_TYPE_DATASET;
    }

    [[nodiscard]] Values open(const std::string& dataset) const {
        Values values = Values::dataset(root.get(), from_root(dataset));
        values.require_within(bytes);
        return values;
    }

    /// HDF5 crashes where it lists attributes of which one cannot be read. Looking for a name that none has reads
    /// them all, and fails as it should.
    void require_readable_attributes(const std::string& object) const {
        hdf::checked(H5Aexists_by_name(root.get(), from_root(object).c_str(), "\x01", H5P_DEFAULT), object);
    }

    [[nodiscard]] std::vector<std::string> attribute_names(const std::string& object) const {
        require_readable_attributes(object);
        std::vector<std::string> found;
        hsize_t position = 0;
        hdf::checked(H5Aiterate_by_name(root.get(), from_root(object).c_str(), H5_INDEX_NAME, H5_ITER_INC, &position,
                                        collect_name, &found, H5P_DEFAULT),
                     object);
        return found;
    }

    [[nodiscard]] std::optional<std::string> attribute(const std::string& object, const std::string& name) const {
        if (hdf::checked(H5Aexists_by_name(root.get(), from_root(object).c_str(), name.c_str(), H5P_DEFAULT), object) ==
            0)
            return std::nullopt;
        const Values values = Values::attribute(root.get(), from_root(object), name);
        return joined(values.texts(0, values.rows()), ", ");
    }

    [[nodiscard]] std::vector<std::pair<std::string, H5O_type_t>> objects() const {
        Collected collected;
        const herr_t status =
            H5Ovisit2(root.get(), H5_INDEX_NAME, H5_ITER_INC, collect_object, &collected, H5O_INFO_BASIC);
        if (collected.out_of_memory) throw std::bad_alloc();
        hdf::checked(status, "its tree of groups");
        for (auto& [name, type] : collected.objects) {
            if (name == ".") name.clear();
            name.insert(name.begin(), '/');
        }
        return std::move(collected.objects);
    }

    void refuse_path(const std::string& wanted) const;
    [[nodiscard]] Values open_attribute(const std::string& object, const std::string& name) const;
    [[nodiscard]] Values find(const std::string& path_or_attribute) const;
};

std::string shape_text(const std::vector<std::uint64_t>& shape) {
    if (shape.empty()) return "scalar";
    std::vector<std::string> lengths;
    lengths.reserve(shape.size());
    for (const std::uint64_t length : shape) lengths.push_back(std::to_string(length));
    std::string text = "(";
    return text.append(joined(lengths, ", ")).append(")");
}

ArchiveFile::ArchiveFile(const std::filesystem::path& file, const std::string& root) : impl_(std::make_unique<Impl>()) {
    impl_->path = file;
    std::error_code error;
    impl_->bytes = std::filesystem::file_size(file, error);
    if (error) throw UnknownName("cannot open '" + file.string() + "': " + error.message());
    impl_->guarded([&] {
        impl_->file = hdf::Handle(H5Fopen(file.c_str(), H5F_ACC_RDONLY, hdf::file_access().get()), H5Fclose,
                                  "no complete HDF5 file");
        impl_->root =
            hdf::Handle(H5Gopen2(impl_->file.get(), root.c_str(), H5P_DEFAULT), H5Gclose, "the group " + root);
        impl_->format = impl_->attribute("/", "format").value_or("");
        if (impl_->format != names::kModelFormat && impl_->format != names::kCohortFormat)
            throw hdf::Error("its attribute 'format' is '" + impl_->format + "', not '" +
                             std::string(names::kModelFormat) + "' or '" + std::string(names::kCohortFormat) +
                             "': it was not written by lumenline");
        const std::string written = impl_->attribute("/", "format_version").value_or("missing");
        if (written != std::to_string(names::kFormatVersion))
            throw hdf::Error("its format version is " + written + ", and this program reads version " +
                             std::to_string(names::kFormatVersion));
    });
}

ArchiveFile::~ArchiveFile() {
    const hdf::Quiet quiet;
    impl_.reset();
}
ArchiveFile::ArchiveFile(ArchiveFile&&) noexcept = default;

const std::filesystem::path& ArchiveFile::file() const { return impl_->path; }
const std::string& ArchiveFile::format() const { return impl_->format; }

bool ArchiveFile::has(const std::string& path) const {
    return impl_->guarded([&] {
        // H5Lexists fails, rather than say no, where a group on the way does not exist.
        for (std::size_t end = path.find('/', 1); end != std::string::npos; end = path.find('/', end + 1))
            if (H5Lexists(impl_->root.get(), Impl::from_root(path.substr(0, end)).c_str(), H5P_DEFAULT) <= 0)
                return false;
        return path == "/" || H5Lexists(impl_->root.get(), Impl::from_root(path).c_str(), H5P_DEFAULT) > 0;
    });
}

std::vector<std::uint64_t> ArchiveFile::shape(const std::string& path) const {
    return impl_->guarded([&] { return impl_->open(path).shape(); });
}

std::vector<double> ArchiveFile::numbers(const std::string& path) const {
    return impl_->guarded([&] {
        const Values values = impl_->open(path);
        return values.numbers(0, values.rows());
    });
}

std::string ArchiveFile::bytes(const std::string& path) const {
    return impl_->guarded([&] {
        const Values values = impl_->open(path);
        return values.bytes(0, values.rows());
    });
}

std::vector<std::string> ArchiveFile::strings(const std::string& path) const {
    return impl_->guarded([&] {
        const Values values = impl_->open(path);
        if (!values.is_text()) throw hdf::Error(path + ": holds no text but " + values.type());
        return values.texts(0, values.rows());
    });
}

std::optional<std::string> ArchiveFile::attribute(const std::string& object, const std::string& name) const {
    return impl_->guarded([&] { return impl_->attribute(object, name); });
}

std::vector<std::pair<std::string, std::string>> ArchiveFile::attributes(const std::string& object) const {
    return impl_->guarded([&] {
        std::vector<std::pair<std::string, std::string>> found;
        for (const std::string& name : impl_->attribute_names(object))
            found.emplace_back(name, impl_->attribute(object, name).value_or(""));
        return found;
    });
}

std::vector<ArchiveNode> ArchiveFile::nodes() const {
    return impl_->guarded([&] {
        std::vector<ArchiveNode> found;
        for (const auto& [path, type] : impl_->objects()) {
            ArchiveNode node{path, type == H5O_TYPE_GROUP, "", {}, "", ""};
            if (type == H5O_TYPE_DATASET) {
                const Values values = Values::dataset(impl_->root.get(), Impl::from_root(path));
                node.type = values.type();
                node.shape = values.shape();
                node.units = impl_->attribute(path, "units").value_or("");
                node.description = impl_->attribute(path, "description").value_or("");
            }
            found.push_back(std::move(node));
        }
        return found;
    });
}

void ArchiveFile::require_copyable() const {
    impl_->guarded([&] {
        haddr_t end = 0;
        hdf::checked(H5Fget_eoa(impl_->file.get(), &end), "its end");
        for (const auto& [path, type] : impl_->objects()) {
            impl_->require_readable_attributes(path);
            if (type == H5O_TYPE_DATASET) Values::dataset(impl_->root.get(), Impl::from_root(path)).require_stored(end);
        }
    });
}

void ArchiveFile::Impl::refuse_path(const std::string& wanted) const {
    const bool is_file_level = format == names::kModelFormat;
    std::vector<std::string> datasets, inside;
    bool is_group = false;
    for (const auto& [name, type] : objects()) {
        is_group = is_group || (name == wanted && type == H5O_TYPE_GROUP);
        if (type != H5O_TYPE_DATASET) continue;
        datasets.push_back(name);
        if (name.starts_with(wanted == "/" ? wanted : wanted + "/")) inside.push_back("'" + printable(name) + "'");
    }
    const std::string place = is_file_level ? "model file '" : "index '";
    if (is_group)
        throw UnknownName("'" + printable(wanted) + "' is a group of the " + place + path.string() +
                          "', not a dataset; it holds " + (inside.empty() ? "no datasets" : joined(inside, ", ")));
    throw UnknownName("the " + place + path.string() + "' has no dataset '" + printable(wanted) + "'" +
                      nearest_names(wanted, datasets));
}

Values ArchiveFile::Impl::open_attribute(const std::string& object, const std::string& name) const {
    const auto all = objects();
    if (std::none_of(all.begin(), all.end(), [&](const auto& o) { return o.first == object; })) {
        std::vector<std::string> known;
        known.reserve(all.size());
        for (const auto& [path_in_file, type] : all) known.push_back(path_in_file);
        throw UnknownName("'" + path.string() + "' has no object '" + printable(object) + "'" +
                          nearest_names(object, known));
    }
    const std::vector<std::string> known = attribute_names(object);
    if (std::find(known.begin(), known.end(), name) == known.end())
        throw UnknownName("'" + printable(object) + "' of '" + path.string() + "' has no attribute '" +
                          printable(name) + "'" + nearest_names(name, known));
    return Values::attribute(root.get(), from_root(object), name);
}

Values ArchiveFile::Impl::find(const std::string& path_or_attribute) const {
    const std::string full = path_or_attribute.starts_with('/') ? path_or_attribute : "/" + path_or_attribute;
    if (const std::size_t mark = full.rfind('@'); mark != std::string::npos)
        return open_attribute(full.substr(0, mark), full.substr(mark + 1));
    if (full == "/" || full.ends_with('/') || !is_dataset(full)) refuse_path(full);
    return open(full);
}

void ArchiveFile::print(const std::string& path_or_attribute, std::ostream& out) const {
    impl_->guarded([&] { print_values(impl_->find(path_or_attribute), out); });
}

void ArchiveFile::save_npy(const std::string& path_or_attribute, std::ostream& out) const {
    impl_->guarded([&] { hdf::write_npy(impl_->find(path_or_attribute), out); });
}

}  // namespace lumenline
