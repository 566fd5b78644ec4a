#pragma once

// Idea: what camera.txt and world.yaml call the camera models.

#include "ldso/calibration.h"

namespace ldso::simulation {

inline const char* model_name(CameraModelKind kind) {
  switch (kind) {
    case CameraModelKind::kPinhole:
      return "Pinhole";
    case CameraModelKind::kFov:
      return "FOV";
    case CameraModelKind::kRadTan:
      return "RadTan";
    case CameraModelKind::kKannalaBrandt:
      return "KannalaBrandt";
  }
  return "";
}

}  // namespace ldso::simulation
