#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "config/cohort.h"

namespace lumenline::testing {

inline std::string read_file(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

/// A fresh folder of the running test, for a cohort file and what it names.
class Folder {
public:
    Folder() {
        const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
        path_ =
            std::filesystem::path(::testing::TempDir()) / "lumenline_config" / test->test_suite_name() / test->name();
        std::filesystem::remove_all(path_);
        std::filesystem::create_directories(path_);
    }

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

    std::filesystem::path write(const std::string& name, const std::string& content) const {
        const std::filesystem::path file = path_ / name;
        std::filesystem::create_directories(file.parent_path());
        std::filesystem::remove(file);  // some file systems sync when a file is truncated and rewritten
        std::ofstream(file, std::ios::binary) << content;
        return file;
    }

    CohortConfig load(const std::string& yaml) const { return load_cohort(write("cohort.yaml", yaml)); }

    /// The error of that YAML as "NAME:LINE: sentence", without the folder; "" when it loads.
    std::string error(const std::string& yaml) const {
        try {
            load(yaml);
            return "";
        } catch (const ConfigError& e) {
            std::string text = e.what();
            const std::string prefix = path_.string() + "/";
            EXPECT_EQ(text.find('\n'), std::string::npos) << text;
            EXPECT_TRUE(text.starts_with(prefix)) << text;
            for (std::size_t at = text.find(prefix); at != std::string::npos; at = text.find(prefix))
                text.erase(at, prefix.size());
            return text;
        }
    }

private:
    std::filesystem::path path_;
};

/// A cohort of one model with `more` between its name and its models.
inline std::string with(const std::string& more) {
    return "cohort: c\n" + more + "\nmodels:\n  - id: a\n    surface: a.stl\n";
}

/// A cohort of one model with `more` as further lines of the model; its first is line 5 of the file.
inline std::string model_with(const std::string& more) {
    return "cohort: c\nmodels:\n  - id: a\n    surface: a.stl\n    " + more + "\n";
}

}  // namespace lumenline::testing
