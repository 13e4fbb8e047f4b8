#pragma once

#include "engine/phantom/phantom.h"

namespace lumenline {

/// How a phantom is sampled.
struct VoxelOptions {
    double size = 0.2;  ///< of a cubic voxel, as a share of the section's least radius
    int smoothing = 0;  ///< passes of Taubin's smoothing; 0 = the staircase itself
};

/// A phantom as a segmented image shows it: voxels whose centre is inside, their outer faces cut into two
/// triangles each, and smoothed. The ends are closed, the truth is that of the shape. Vertices of the
/// staircase are within sqrt(3)/2 voxels of the wall or of an end's plane, but where voxels that touched
/// only by an edge or a corner had one filled beside them, so that the surface is a manifold.
///
/// The rotation of `options` turns the shape against the grid; points around, jitter, noise and caps are
/// ignored. edge_length is the voxel's.
/// @throws std::invalid_argument as PhantomTruth, for a size outside (0, 1], fewer than no or more than
///         1000 passes, more than 2^28 voxels, and where voxels are too large to tell parts of the
///         shape from each other or to hold it together
/// @cost one inside query per voxel of the bounding box
Phantom make_voxel_phantom(const PhantomOptions& options, const VoxelOptions& voxels);

}  // namespace lumenline
