#pragma once

namespace lumenline {

/// Memory that this process may use: that of the machine, or the limit of its control group (a container, a batch
/// job) or of the process where that is less [bytes].
double available_memory();

/// Memory that a model of so many sites needs while it is computed and written [bytes]. Measured peaks, with margin.
double estimated_memory(double sites);

/// Work on a model of so many sites [s, one thread], and the size of its file [bytes]. Orders of magnitude.
double estimated_seconds(double sites);
double estimated_file_bytes(double sites, bool float32_fields);

}  // namespace lumenline
