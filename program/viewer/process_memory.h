#pragma once

// Memory that the program holds at the moment.

namespace ldso {

/// Resident [MB]; 0 where it cannot be told.
double process_memory_mb();

}  // namespace ldso
