#include "ldso/viewer.h"

#include "viewer/live_run.h"

namespace ldso {

struct Viewer::Impl {
  LiveRun run;
};

Viewer::Viewer(const ViewerOptions& options) {
  LiveRunOptions run;
  run.name = options.name;
  run.server = make_server_options(options.address);
  run.has_control = false;
  impl_ = std::unique_ptr<Impl>(new Impl{LiveRun(std::move(run))});
}

Viewer::~Viewer() = default;

std::string Viewer::url() const { return impl_->run.url(); }

std::shared_ptr<RunObserver> Viewer::observer() const { return impl_->run.observer(); }

void Viewer::log(LogLevel level, const std::string& text) { impl_->run.log(level, text); }

void Viewer::finish() { impl_->run.finish(); }

}  // namespace ldso
