#include "interface/guard.h"

#include "ldso/error.h"
#include "util/out_of_memory.h"

namespace ldso::c {
namespace {

/// For when there is no room to say more.
constexpr const char* kNoMemory = "out of memory";

thread_local std::string last_error;
thread_local bool has_no_room = false;

}  // namespace

void set_last_error(const std::exception& error) noexcept {
  try {
    last_error = problem_of(error, "working for a program in C");
    has_no_room = false;
  } catch (...) {
    has_no_room = true;
  }
}

void require(const void* pointer, const char* what) {
  if (pointer == nullptr) throw Error(what, "it is NULL", "check what the function that made it returned");
}

}  // namespace ldso::c

extern "C" {

const char* ldso_version(void) { return LDSO_VERSION; }

const char* ldso_last_error(void) {
  return ldso::c::has_no_room ? ldso::c::kNoMemory : ldso::c::last_error.c_str();
}
}
