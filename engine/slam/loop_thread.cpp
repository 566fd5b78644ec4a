#include "slam/loop_thread.h"

#include <exception>
#include <utility>

#include "place/default_vocabulary.h"
#include "place/vocabulary_file.h"
#include "slam/packed_keyframe.h"
#include "util/log.h"
#include "util/out_of_memory.h"

namespace ldso {
namespace {

std::shared_ptr<const Vocabulary> read_given(const LoopSettings& settings) {
  if (settings.vocabulary.empty()) return nullptr;
  return std::make_shared<const Vocabulary>(read_vocabulary(settings.vocabulary));
}

}  // namespace

LoopThread::LoopThread(const LoopSettings& settings, LogSink log, std::shared_ptr<RunObserver> observer,
                       const FramePreprocessor* preprocessor)
    : log_(std::move(log)),
      settings_(settings),
      correction_lag_(static_cast<std::size_t>(settings.correction_lag)),
      max_waiting_(static_cast<std::size_t>(settings.max_waiting)),
      vocabulary_(read_given(settings)),
      preprocessor_(preprocessor),
      queue_(max_waiting_),
      observer_(std::move(observer)),
      thread_([this](const std::stop_token& stop) { work(stop); }) {}

LoopThread::~LoopThread() {
  thread_.request_stop();
  queue_.close();
}

void LoopThread::add(FinishedKeyframe keyframe) {
  {
    const std::lock_guard lock(mutex_);
    ++added_;
  }
  queue_.push(std::move(keyframe));
}

void LoopThread::publish(const Sim3d& correction) {
  const std::lock_guard lock(mutex_);
  ++done_;
  corrections_.push_back(correction);
  if (corrections_.size() > correction_lag_ + max_waiting_) corrections_.pop_front();
  published_.notify_all();
}

Sim3d LoopThread::correction() {
  std::unique_lock lock(mutex_);
  if (added_ <= correction_lag_) return Sim3d();
  const std::size_t wanted = added_ - correction_lag_;
  published_.wait(lock, [&] { return done_ >= wanted || ended_; });
  if (done_ < wanted) return corrections_.empty() ? Sim3d() : corrections_.back();  // It failed: that is the last one.
  const std::size_t back = done_ - wanted;
  return back < corrections_.size() ? corrections_[corrections_.size() - 1 - back] : corrections_.front();
}

KnownLoops LoopThread::known() {
  const std::lock_guard lock(mutex_);
  return known_;
}

std::vector<std::int64_t> LoopThread::newly_forgotten() {
  const std::lock_guard lock(mutex_);
  return std::exchange(forgotten_, {});
}

void LoopThread::note_forgotten() {
  const MapKeyframe& newest = closer_->map()[closer_->map().size() - 1];
  if (!newest.is_forgotten) return;
  const std::lock_guard lock(mutex_);
  forgotten_.push_back(newest.frame_id);
}

void LoopThread::remember() {
  if (closer_->optimizations() == optimizations_known_) return;
  optimizations_known_ = closer_->optimizations();
  KnownLoops known{closer_->poses(), {}, closer_->correction()};
  for (const LoopRecord& loop : closer_->loops()) {
    if (!loop.accepted) continue;
    known.accepted.push_back(loop);
    known.accepted.back().matches.clear();
  }
  const std::lock_guard lock(mutex_);
  known_ = std::move(known);
}

void LoopThread::process(const std::stop_token& stop) {
  if (!vocabulary_) vocabulary_ = std::make_shared<const Vocabulary>(default_vocabulary());
  closer_ = std::make_unique<LoopCloser>(vocabulary_, settings_);
  while (std::optional<FinishedKeyframe> keyframe = queue_.pop()) {
    if (stop.stop_requested()) return;
    if (preprocessor_ != nullptr) unpack(*preprocessor_, *keyframe);
    closer_->add(keyframe->update, keyframe->corners, keyframe->frame->pyramid.levels.front(), keyframe->update.camera);
    remember();
    note_forgotten();
    publish(closer_->correction());
    tell();
  }
  if (stop.stop_requested()) return;
  closer_->finish();
  remember();
  if (closer_->optimizations() > optimizations_told_) tell();
  if (!closer_->graph_failure().empty()) {
    log_to(log_, LogLevel::kWarning, "the last loops move no keyframe: " + closer_->graph_failure());
  }
}

void LoopThread::tell() {
  if (!observer_) return;
  LoopEvent event;
  const std::vector<LoopRecord>& loops = closer_->loops();
  loops_told_.resize(loops.size(), false);
  for (std::size_t i = 0; i < loops.size(); ++i) {
    if (!loops[i].accepted || loops_told_[i]) continue;
    loops_told_[i] = true;
    event.accepted.push_back(loops[i]);
    event.accepted.back().matches.clear();
  }
  if (closer_->optimizations() > optimizations_told_) {
    event.poses = closer_->poses();
    optimizations_told_ = closer_->optimizations();
  } else {
    event.poses.push_back(closer_->newest_pose());
  }
  event.correction = closer_->correction();
  event.candidates = static_cast<int>(loops.size());
  observer_->on_loops(std::move(event));
}

void LoopThread::work(const std::stop_token& stop) {
  bool failed = false;
  try {
    process(stop);
  } catch (const std::exception& error) {
    failed = true;
    log_to(log_, LogLevel::kWarning, "loop closing ends: " + problem_of(error, "closing loops"));
    queue_.close();
  }
  const std::lock_guard lock(mutex_);
  failed_ = failed;
  ended_ = true;
  published_.notify_all();
}

const LoopCloser* LoopThread::finish() {
  queue_.close();
  if (thread_.joinable()) thread_.join();
  return failed_ ? nullptr : closer_.get();
}

}  // namespace ldso
