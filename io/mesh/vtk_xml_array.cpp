// Arrays of VTK XML files. An array that is not text is a header and bytes: without compression the header is the
// number of bytes; with it, n, b, p, c1 ... cn, for n blocks of b bytes each once unpacked (the last one of p bytes
// unless p = 0), which take c1 ... cn bytes in the file. Header and bytes stand in the file as they are or as base64.
//
// The array's count is known before its header is looked at, and the header must agree with it to the byte. So the
// memory follows from the count, and the count is held against the bytes that are there: as they are, or at the
// most that zlib can pack into them. A block that unpacks to another size than stated is refused, and none is
// unpacked any further than that.

#include "io/mesh/vtk_xml_array.h"

#include <zlib.h>

#include <array>
#include <string>

#include "engine/core/text.h"
#include "io/mesh/base64.h"

namespace lumenline::mesh {
namespace {

constexpr std::uint64_t kLargestRatio = 1032;  // of deflate: 258 bytes in two bits

struct Block {
    std::uint64_t size = 0;    // unpacked
    std::uint64_t packed = 0;  // in the file
};

class ArrayDecoder {
public:
    ArrayDecoder(const SourceFile& file, const XmlStorage& storage, const XmlArray& array, std::uint64_t size)
        : file_(file),
          storage_(storage),
          stored_(file, array.begin, array.end, array.format == XmlArray::Format::kBase64),
          size_(size) {}

    /// Takes the header of an array without compression.
    void check_header() {
        const std::size_t begin = stored_.position();
        const std::uint64_t stated = header_number();
        if (stated != size_) {
            fail(begin, "expected an array of " + counted(size_, "byte") + ", found a header that states " +
                            std::to_string(stated));
        }
        if (size_ > stored_.remaining()) {
            fail(begin, "expected an array of " + counted(size_, "byte") + ", found at most " +
                            std::to_string(stored_.remaining()) + " before its end");
        }
    }

    [[nodiscard]] std::size_t position() const { return stored_.position(); }

    std::vector<char> plain() {
        check_header();
        std::vector<char> bytes(size_);
        stored_.read(bytes.data(), bytes.size(), "an array");
        return bytes;
    }

    std::vector<char> unpacked() {
        const std::size_t begin = stored_.position();
        const std::vector<Block> blocks = parse_blocks();
        std::uint64_t packed = 0;
        for (const Block& block : blocks) {
            // Compared before they are added: a sum of lies could run over.
            if (block.packed > stored_.remaining() || packed + block.packed > stored_.remaining()) {
                fail(begin, "expected a compressed block of " + counted(block.packed, "byte") + ", found at most " +
                                std::to_string(stored_.remaining() - packed) + " before the end of the array");
            }
            packed += block.packed;
        }
        if (size_ / kLargestRatio > packed) {
            fail(begin, "expected an array of " + counted(size_, "byte") + ", found only " +
                            counted(packed, "compressed byte"));
        }
        std::vector<char> bytes(size_);
        std::vector<char> scratch;
        std::size_t done = 0;
        for (const Block& block : blocks) {
            unpack(block, scratch, bytes.data() + done);
            done += block.size;
        }
        return bytes;
    }

private:
    [[noreturn]] void fail(std::size_t position, const std::string& what) const {
        fail_at(file_, position, ErrorCode::kFileFormat, what);
    }

    std::uint64_t header_number() {
        std::array<char, 8> bytes{};
        stored_.read(bytes.data(), storage_.header_size, "a header");
        return storage_.header_size == 8 ? load<std::uint64_t>(bytes.data(), storage_.encoding)
                                         : load<std::uint32_t>(bytes.data(), storage_.encoding);
    }

    std::vector<Block> parse_blocks() {
        const std::size_t begin = stored_.position();
        const std::uint64_t count = header_number();
        const std::uint64_t size = header_number();
        const std::uint64_t partial = header_number();
        const std::uint64_t last = partial == 0 ? size : partial;
        if (count == 0 || count > stored_.remaining() / storage_.header_size || last > size_ ||
            (count > 1 && size == 0) || (size > 0 && count - 1 > size_ / size) || (count - 1) * size + last != size_) {
            fail(begin, "expected an array of " + counted(size_, "byte") + ", found a header that states " +
                            counted(count, "block") + " of " + counted(size, "byte") + " and a last one of " +
                            std::to_string(last));
        }
        std::vector<Block> blocks(count);
        for (Block& block : blocks) block = {size, header_number()};
        blocks.back().size = last;
        return blocks;
    }

    void unpack(const Block& block, std::vector<char>& scratch, char* out) {
        const std::size_t begin = stored_.position();
        scratch.resize(block.packed);
        stored_.read(scratch.data(), scratch.size(), "a compressed block");
        uLongf size = block.size;
        const int status = uncompress(reinterpret_cast<Bytef*>(out), &size,
                                      reinterpret_cast<const Bytef*>(scratch.data()), scratch.size());
        if (status == Z_MEM_ERROR) throw std::bad_alloc();
        if (status != Z_OK || size != block.size) {
            fail(begin, "expected a zlib block that unpacks to " + counted(block.size, "byte") + ", found " +
                            (status == Z_OK          ? counted(size, "byte")
                             : status == Z_BUF_ERROR ? std::string("more, or a block that is cut off")
                                                     : std::string("damaged data")));
        }
    }

    const SourceFile& file_;
    const XmlStorage& storage_;
    StoredBytes stored_;
    std::uint64_t size_;
};

}  // namespace

XmlNumbers::XmlNumbers(const SourceFile& file, const XmlStorage& storage, const XmlArray& array, std::uint64_t count)
    : file_(file),
      type_(array.type),
      source_(open(storage, array, count)),
      cursor_(source_, begin_, Layout::kFree),
      reader_(source_, cursor_, array.format == XmlArray::Format::kText ? Encoding::kText : storage.encoding) {}

SourceFile XmlNumbers::open(const XmlStorage& storage, const XmlArray& array, std::uint64_t count) {
    constexpr std::string_view kEnd = "the end of the array";
    file_.text = array.format != XmlArray::Format::kRaw;
    SourceFile source{file_.path, file_.bytes.substr(0, array.end), file_.text, kEnd};
    begin_ = array.begin;
    if (array.format == XmlArray::Format::kText) {
        // One character and a blank each; the last one needs no blank.
        check_count(source, begin_, count, 1, "numbers");
        if (count > 0) check_count(source, begin_, 2 * count - 1, 1, "characters of numbers and blanks");
        return source;
    }
    if (count == 0) return source;
    const std::uint64_t size = count * scalar_size(array.type);
    ArrayDecoder decoder(file_, storage, array, size);
    if (array.format == XmlArray::Format::kRaw && !storage.compressed) {
        decoder.check_header();
        begin_ = decoder.position();
        return source;
    }
    decoded_ = storage.compressed ? decoder.unpacked() : decoder.plain();
    source.bytes = {decoded_.data(), decoded_.size()};
    source.text = false;
    source.origin = &file_;
    source.origin_position = begin_;
    begin_ = 0;
    return source;
}

void XmlNumbers::expect_end() {
    if (reader_.encoding() != Encoding::kText || cursor_.peek().empty()) return;
    cursor_.fail_expected(cursor_.position(), "no more numbers in the array");
}

std::size_t XmlNumbers::position() const {
    return source_.origin != nullptr ? source_.origin_position : reader_.last_position();
}

void XmlNumbers::fail(const std::string& what) const {
    fail_at(source_, reader_.last_position(), ErrorCode::kFileFormat, what);
}

}  // namespace lumenline::mesh
