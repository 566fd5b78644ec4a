#include "app/progress_display.h"

#include <cstdio>

namespace ldso {
namespace {

const char* name_of(TrackingState state) {
  switch (state) {
    case TrackingState::kInitializing:
      return "initializing";
    case TrackingState::kTracked:
      return "tracked";
    case TrackingState::kLost:
      return "lost";
  }
  return "";
}

}  // namespace

void ProgressDisplay::update(const RunProgress& progress) {
  const double seconds = bar_.seconds();
  char text[160];
  std::snprintf(text, sizeof(text), "frame %d/%d  %.1f frames/s  %d keyframes  %s", progress.done, progress.count,
                seconds > 0 ? progress.done / seconds : 0.0, progress.keyframes, name_of(progress.frame.state));
  bar_.update(progress.done, progress.count, text);
}

}  // namespace ldso
