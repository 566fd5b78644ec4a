#pragma once

// A camera that is plugged in, or one that sends its images over a network.

#include <memory>
#include <optional>
#include <string>

#include "camera/frame_stream.h"
#include "ldso/io/dataset.h"

namespace ldso {

/// "0" of "camera:0": the camera's number, its device (camera:/dev/video2) or the address of a stream
/// (camera:rtsp://...). Nothing if `input` is no camera.
std::optional<std::string> camera_of(const std::string& input);

/// Opens a camera by what camera_of() gives. Of the options `calibration_file` must be there, `fps` asks for a frame
/// rate and `end` is after how many frames it ends; the image size is asked for as the calibration has it. Timestamps
/// are those of the system's clock [s]. Throws Error saying what to do if there is no calibration or no such camera, or
/// if it gives images of another size.
std::unique_ptr<FrameStream> open_camera(const std::string& camera, const DatasetOptions& options);

/// What the rest of a run wants to know of the sequence: there is no ground truth, and its images are gone.
std::unique_ptr<Dataset> make_camera_dataset(const std::string& camera, const Calibration& calibration);

}  // namespace ldso
