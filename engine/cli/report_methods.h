#pragma once

#include <map>
#include <string>
#include <vector>

namespace lumenline {

/// What the methods section of a paper needs to say of a cohort.
struct MethodsFacts {
    std::string program, commit, hdf5;           ///< of the runs; "several versions" where they differ
    std::map<std::string, std::string> options;  ///< key, value; "differs" where models have different ones
    std::size_t models = 0, failed = 0, rated_bad = 0;
    bool characterized = false, branched = false;
};

/// Paragraphs on the method, with the options that were used, ready to be pasted; numbers in brackets refer to
/// `methods_references`.
std::vector<std::string> methods_text(const MethodsFacts& facts);

/// The publications, in the order of their numbers.
std::vector<std::string> methods_references();

}  // namespace lumenline
