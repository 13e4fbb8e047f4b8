#include "io/export/picture.h"

#include <png.h>

#include <stdexcept>

namespace lumenline {

std::string png_of(const Picture& picture) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = static_cast<png_uint_32>(picture.width);
    image.height = static_cast<png_uint_32>(picture.height);
    image.format = PNG_FORMAT_RGBA_COLORMAP;
    image.colormap_entries = static_cast<png_uint_32>(picture.palette.size());
    const auto written = [&](void* target, png_alloc_size_t& bytes) {
        return png_image_write_to_memory(&image, target, &bytes, 0, picture.pixels.data(), 0, picture.palette.data());
    };
    png_alloc_size_t bytes = PNG_IMAGE_PNG_SIZE_MAX(image);
    std::string file(bytes, '\0');
    if (written(file.data(), bytes) == 0) throw std::runtime_error(std::string("cannot make a PNG: ") + image.message);
    file.resize(bytes);
    return file;
}

}  // namespace lumenline
