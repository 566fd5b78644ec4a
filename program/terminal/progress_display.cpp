#include "terminal/progress_display.h"

#include "util/format_text.h"

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
  const int processed = progress.done - progress.dropped;
  const std::string of = progress.count > 0 ? std::string("/").append(std::to_string(progress.count)) : "";
  const std::string dropped = progress.dropped > 0 ? std::to_string(progress.dropped) + " dropped  " : "";
  const std::string text = format_text("frame %d%s  %.1f frames/s  %d keyframes  %s%s", progress.done, of.c_str(),
                                       seconds > 0 ? processed / seconds : 0.0, progress.keyframes, dropped.c_str(),
                                       name_of(progress.frame.state));
  bar_.update(progress.done, progress.count, text);
}

}  // namespace ldso
