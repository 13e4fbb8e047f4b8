#pragma once

#include "engine/core/archive_options.h"

namespace lumenline {

/// Memory that this process may use: that of the machine, or the limit of its control group (a container), of its batch
/// job (Slurm) or of the process where that is less [bytes].
double available_memory();

/// Memory that a model of so many sites needs while it is computed and written [bytes]. Measured peaks, with margin.
double estimated_memory(double sites);

/// Greatest resident memory of this process since it began, or since `forget_peak` [bytes].
double peak_resident_bytes();
void forget_peak();

/// Gives memory that was freed back to the system.
void give_back_free_memory();

/// From now on, memory that this process asks for beyond so many bytes more than it has is refused: allocation fails.
/// @returns false where the system has no such limit
bool limit_memory(double bytes);

/// Work on a model of so many sites [s, one thread], and the size of its file [bytes]. Orders of magnitude.
double estimated_seconds(double sites);
double estimated_file_bytes(double sites, const ArchiveOptions& archive);

}  // namespace lumenline
