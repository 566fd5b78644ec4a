#include "viewer/process_memory.h"

#include <unistd.h>

#include <fstream>

namespace ldso {

double process_memory_mb() {
  std::ifstream file("/proc/self/statm");
  double total = 0, resident = 0;
  file >> total >> resident;
  return file ? resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6 : 0;
}

}  // namespace ldso
