#pragma once

// What lies behind the opaque handles, and the wall that no exception passes.

#include <exception>
#include <string>
#include <vector>

#include "ldso.h"
#include "ldso/calibration.h"
#include "ldso/settings.h"
#include "ldso/slam.h"

struct ldso_calibration {
  ldso::Calibration calibration;
};
struct ldso_settings {
  ldso::Settings settings;
};
struct ldso_result {
  ldso::SlamResult result;
  std::vector<ldso::TimedPose> poses;
  std::vector<ldso::WorldPoint> points;
};

namespace ldso::c {

/// Keeps what ldso_last_error() says on this thread.
void set_last_error(const std::exception& error) noexcept;

/// Throws Error, which names `what`, for a null pointer.
void require(const void* pointer, const char* what);

/// Calls it; what it throws becomes the last error, and `failed` is returned.
template <class Result, class Action>
Result guarded(Result failed, const Action& action) noexcept {
  try {
    return action();
  } catch (const std::exception& error) {
    set_last_error(error);
    return failed;
  }
}

}  // namespace ldso::c
