#pragma once

#include <memory>
#include <utility>

#include "ldso/observer.h"

namespace ldso::python {

/// Tells both.
class ObserverPair final : public RunObserver {
 public:
  ObserverPair(std::shared_ptr<RunObserver> first, std::shared_ptr<RunObserver> second)
      : first_(std::move(first)), second_(std::move(second)) {}

  void on_start(const PinholeIntrinsics& camera) override {
    first_->on_start(camera);
    second_->on_start(camera);
  }
  void on_frame(FrameEvent event) override {
    first_->on_frame(event);
    second_->on_frame(std::move(event));
  }
  void on_keyframe(const KeyframeUpdate& keyframe, const PinholeIntrinsics& camera) override {
    first_->on_keyframe(keyframe, camera);
    second_->on_keyframe(keyframe, camera);
  }
  void on_loops(LoopEvent event) override {
    first_->on_loops(event);
    second_->on_loops(std::move(event));
  }
  bool wants_view() override {
    first_wants_ = first_->wants_view();
    second_wants_ = second_->wants_view();
    return first_wants_ || second_wants_;
  }
  void on_view(LiveView view) override {
    if (first_wants_) first_->on_view(view);
    if (second_wants_) second_->on_view(std::move(view));
  }

 private:
  std::shared_ptr<RunObserver> first_, second_;
  bool first_wants_ = false, second_wants_ = false;  ///< The view that comes next, if one does.
};

/// Either may be none.
inline std::shared_ptr<RunObserver> observe_both(std::shared_ptr<RunObserver> first,
                                                 std::shared_ptr<RunObserver> second) {
  if (!first || !second) return first ? first : second;
  return std::make_shared<ObserverPair>(std::move(first), std::move(second));
}

}  // namespace ldso::python
