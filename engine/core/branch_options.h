#pragma once

namespace lumenline {

/// Options of engine/branches.
struct BranchOptions {
    bool enabled = true;        ///< run the stage
    double step = 0.25;         ///< between points of a branch's axis [its mean radii]
    double smoothing = 2;       ///< half the window that curvature and torsion are fitted in [local radii]
    double section_step = 0.5;  ///< between sections [mean radii of the branch]
    int patches_along = 10;     ///< (L) bins of a branch along its axis
    int patches_around = 12;    ///< (A) bins around it
};

}  // namespace lumenline
