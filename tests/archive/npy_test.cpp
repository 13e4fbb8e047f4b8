// Files of numpy's format: held against the format's own description here, and read by numpy where it is installed.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "io/archive/model_file.h"
#include "io/archive/read.h"
#include "tests/archive/sample_record.h"

namespace lumenline {
namespace {

std::string npy(const ArchiveFile& file, const std::string& path) {
    std::ostringstream out;
    file.save_npy(path, out);
    return out.str();
}

std::filesystem::path sample_file(const std::string& name) {
    std::filesystem::path file = fresh_directory(name) / "m.hdf";
    write_model_file(file, sample_record());
    return file;
}

TEST(Npy, HeaderAndBytesAreThoseOfTheFormat) {
    const ArchiveFile file(sample_file("npy"));
    const std::string pole = npy(file, "/surface/pole");
    EXPECT_EQ(pole.substr(0, 8), std::string("\x93NUMPY\x01\x00", 8));
    const std::size_t length = static_cast<unsigned char>(pole[8]) + 256U * static_cast<unsigned char>(pole[9]);
    EXPECT_EQ((10 + length) % 64, 0U) << "data start at a multiple of 64";
    EXPECT_EQ(pole[10 + length - 1], '\n');
    EXPECT_EQ(pole.substr(10, 56), "{'descr': '<i4', 'fortran_order': False, 'shape': (5, ),");
    EXPECT_EQ(pole.size(), 10 + length + 5 * 4);
    EXPECT_EQ(pole.substr(10 + length, 8), std::string("\0\0\0\0\3\0\0\0", 8)) << "little-endian";
    EXPECT_NE(npy(file, "/surface/points").find("'<f8', 'fortran_order': False, 'shape': (5, 3),"), std::string::npos);
    EXPECT_NE(npy(file, "/surface/origin").find("'|u1'"), std::string::npos);
    EXPECT_NE(npy(file, "/timing/total_seconds").find("'shape': (),"), std::string::npos);
    EXPECT_NE(npy(file, "/endpoints/kind").find("'<U8'"), std::string::npos);
    EXPECT_THROW(npy(file, "/surface/none"), UnknownName);
    EXPECT_THROW(npy(file, "/surface"), UnknownName);
}

TEST(Npy, NumpyReadsEveryDataset) {
    std::string python;
    for (const char* candidate : {"python3", "/usr/bin/python3"})
        if (python.empty() && std::system((std::string(candidate) + " -c 'import numpy, h5py' 2>/dev/null").c_str()) == 0)
            python = candidate;
    if (python.empty()) GTEST_SKIP() << "numpy or h5py are not installed (Debian: python3-h5py)";
    const auto path = sample_file("npy_numpy");
    const ArchiveFile file(path);
    std::ofstream list(path.parent_path() / "list.txt");
    std::size_t count = 0;
    for (const ArchiveNode& node : file.nodes()) {
        if (node.is_group) continue;
        const std::string name = std::to_string(count++) + ".npy";
        std::ofstream out(path.parent_path() / name, std::ios::binary);
        file.save_npy(node.path, out);
        list << name << ' ' << node.path << '\n';
    }
    list.close();
    const std::string command = python + " " LUMENLINE_SOURCE_DIR "/tests/archive/npy_reads.py " + path.string();
    EXPECT_EQ(std::system(command.c_str()), 0);
    EXPECT_GT(count, 100U);
}

}  // namespace
}  // namespace lumenline
