// SHA-256 by OpenSSL's EVP interface, which picks the processor's SHA instructions where it has them.

#include "io/mesh/sha256.h"

#include <openssl/evp.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <stdexcept>

namespace lumenline {

namespace {

using Digest = std::array<unsigned char, EVP_MAX_MD_SIZE>;

std::string hexadecimal(const Digest& digest, unsigned int length) {
    static constexpr std::string_view kDigits = "0123456789abcdef";
    std::string text;
    text.reserve(2 * std::size_t{length});
    for (unsigned int i = 0; i < length; ++i) {
        text += kDigits[digest[i] >> 4U];
        text += kDigits[digest[i] & 15U];
    }
    return text;
}

}  // namespace

std::string sha256_hex(std::span<const std::byte> bytes) {
    Digest digest{};
    unsigned int length = 0;
    if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &length, EVP_sha256(), nullptr) != 1) {
        throw std::runtime_error("OpenSSL could not compute a SHA-256 digest of " + std::to_string(bytes.size()) +
                                 " bytes");
    }
    return hexadecimal(digest, length);
}

std::string sha256_hex(std::string_view text) { return sha256_hex(std::as_bytes(std::span(text))); }

std::string sha256_of_file(const std::string& path) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) return "";
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
    if (!file) return "";
    const std::unique_ptr<EVP_MD_CTX, void (*)(EVP_MD_CTX*)> context(EVP_MD_CTX_new(), &EVP_MD_CTX_free);
    bool good = context && EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr) == 1;
    constexpr std::size_t kBlock = std::size_t{1} << 20U;
    const auto block = std::make_unique_for_overwrite<char[]>(kBlock);
    for (std::size_t got = kBlock; good && got == kBlock;) {
        got = std::fread(block.get(), 1, kBlock, file.get());
        good = EVP_DigestUpdate(context.get(), block.get(), got) == 1;
    }
    if (!good || std::ferror(file.get()) != 0) return "";
    Digest digest{};
    unsigned int length = 0;
    return EVP_DigestFinal_ex(context.get(), digest.data(), &length) == 1 ? hexadecimal(digest, length) : "";
}

}  // namespace lumenline
