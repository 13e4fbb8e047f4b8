#pragma once

#include "engine/core/branch_tables.h"

namespace lumenline {

/// The narrowest place of each branch: where the radius is the least share of a straight line fitted to the radii of
/// the own part by repeated medians, which stands for the original lumen.
///
/// Degrees are 1 - d / reference, NASCET's (1991) by the median diameter of up to ten radii of the vessel behind the
/// stenosis, from twice as far as where half of the narrowing is passed; ECST's (1991) by the fitted line. By area they
/// are the same of sections. A branch without a distal part, or without points, holds NaN.
StenosisTable find_stenoses(const BranchAxes& branches, const SectionTable& sections);

/// The widest place of each branch against the same line.
DilationTable find_dilations(const BranchAxes& branches);

}  // namespace lumenline
