#include "terminal/scale_options.h"

#include <tuple>

namespace ldso {

void add_scale_options(CLI::App& command, ScaleRequest& request) {
  CLI::Option* distance = command
                              .add_option_function<std::tuple<int, int, double>>(
                                  "--scale",
                                  [&request](const std::tuple<int, int, double>& v) {
                                    request.distance = KnownDistance{std::get<0>(v), std::get<1>(v), std::get<2>(v)};
                                  },
                                  "Metres by the distance of the camera between two frames")
                              ->type_name("FRAME_A FRAME_B METRES");
  CLI::Option* tag =
      command
          .add_option_function<std::string>(
              "--scale-tag",
              [&request](const std::string& text) { request.tag = parse_april_tag(text, "--scale-tag"); },
              "Metres by an AprilTag of known size anywhere in the sequence, e.g. 36h11:3:0.16 (side "
              "of the black square)")
          ->type_name("FAMILY:ID:METRES");
  CLI::Option* height = command
                            .add_option_function<double>(
                                "--scale-height", [&request](double metres) { request.height = KnownHeight{metres}; },
                                "Metres by the height of the camera above the ground it drives on")
                            ->type_name("METRES");
  distance->excludes(tag)->excludes(height);
  tag->excludes(height);
}

}  // namespace ldso
