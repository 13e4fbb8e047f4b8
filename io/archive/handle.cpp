// HDF5 reports an error as a stack of messages, from the API function that was called down to the
// place where it happened. Only the innermost one says why (errno, a truncated file, an unknown
// name), so it is the one that goes into our sentence.

#include "io/archive/handle.h"

#include <algorithm>

namespace lumenline::hdf {

namespace {

herr_t take_first(unsigned /*position*/, const H5E_error2_t* error, void* text) {
    if (error->desc != nullptr) *static_cast<std::string*>(text) = error->desc;
    return 1;  // stops the walk
}

}  // namespace

Quiet::Quiet() {
    // All we open we close, so the library's own clean-up at exit has nothing to do, except to complain
    // on standard error of identifiers that it lost itself while reading a damaged file.
    H5dont_atexit();
    H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

Quiet::~Quiet() { H5Eset_auto2(H5E_DEFAULT, function_, data_); }

void fail(const std::string& what) {
    std::string reason;
    H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take_first, &reason);
    H5Eclear2(H5E_DEFAULT);
    throw Error(reason.empty() ? what : what + ": " + reason);
}

Handle property_list(hid_t property_class) { return {H5Pcreate(property_class), H5Pclose, "property list"}; }

Handle file_access() {
    Handle access = property_list(H5P_FILE_ACCESS);
    checked(H5Pset_file_locking(access.get(), false, true), "file access");
    checked(H5Pset_fclose_degree(access.get(), H5F_CLOSE_SEMI), "file access");
    return access;
}

Handle string_type(std::size_t bytes) {
    Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "string type");
    checked(H5Tset_size(type.get(), std::max<std::size_t>(bytes, 1)), "string type");
    checked(H5Tset_cset(type.get(), H5T_CSET_UTF8), "string type");
    checked(H5Tset_strpad(type.get(), H5T_STR_NULLPAD), "string type");
    return type;
}

Handle extent(int rank, const hsize_t* shape) {
    return {rank == 0 ? H5Screate(H5S_SCALAR) : H5Screate_simple(rank, shape, nullptr), H5Sclose, "extent"};
}

}  // namespace lumenline::hdf
