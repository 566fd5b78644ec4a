#include "terminal/dataset_options.h"

#include "terminal/option_checks.h"

namespace ldso {

void add_dataset_options(CLI::App& command, DatasetOptions& options) {
  command.add_option("--start", options.start, "First frame")->check(number_from_zero());
  command.add_option("--end", options.end,
                     "First frame that is not used any more; negative: so many left out at the end");
  command.add_option("--stride", options.stride, "Use every n-th frame")->check(positive_number());
  command.add_flag("--reverse", options.reverse, "Play from the last to the first frame");
  command.add_option("--calib", options.calibration_file,
                     "Calibration instead of the sequence's: camera.txt, or as another program wrote it");
  command
      .add_option("--fps", options.fps,
                  "Frame rate of a sequence without times, or to ask a camera for [Hz]; 30000/1001 is one as well")
      ->transform(frame_rate());
  command.add_option("--pattern", options.pattern,
                     "Which images of a folder, e.g. frame-%d.color.png (%d: a number, *: any text)");
  command.add_option(
      "--topic", options.topic,
      "Which images of a ROS bag, e.g. /camera/image_raw; without, those of the only topic that has any");
  command.add_option("--mask", options.mask,
                     "Image, or folder with one for each image, that is white where nothing is to be used; none: not "
                     "even black borders are masked");
}

}  // namespace ldso
