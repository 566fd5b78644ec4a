#pragma once

// A page on which others watch a run while it goes on.
//
//   ldso::Viewer viewer;
//   std::cout << viewer.url() << "\n";
//   ldso::Slam slam(calibration, ldso::Settings{}, {}, viewer.observer());

#include <memory>
#include <string>

#include "ldso/log.h"
#include "ldso/observer.h"

namespace ldso {

struct ViewerOptions {
  /// "ADDRESS:PORT", each of which may be left out. Nothing: this machine alone, a port that is free. Other addresses
  /// than those of this machine alone get a token in the URL.
  std::string address;
  std::string name;  ///< Of what is shown.
};

class Viewer {
 public:
  /// Begins to serve the page. Throws Error if it cannot listen there, or if this library was built without its viewer.
  explicit Viewer(const ViewerOptions& options = {});
  /// Ends the page.
  ~Viewer();
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  /// What a browser is to be given.
  std::string url() const;
  /// For one run at a time; it may outlive the viewer.
  std::shared_ptr<RunObserver> observer() const;
  /// A message that the page shows. From any thread.
  void log(LogLevel level, const std::string& text);
  /// Tells the page that the run is over.
  void finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ldso
