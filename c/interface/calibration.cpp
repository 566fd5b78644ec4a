// Calibrations and settings.

#include <filesystem>
#include <memory>

#include "interface/guard.h"
#include "ldso/io/calibration_file.h"
#include "ldso/io/settings_file.h"
#include "util/whole_file.h"

using ldso::c::guarded;
using ldso::c::require;

extern "C" {

ldso_calibration* ldso_calibration_read(const char* path, int photometric) {
  return guarded<ldso_calibration*>(nullptr, [&] {
    require(path, "path");
    const std::filesystem::path file(path);
    auto made = std::make_unique<ldso_calibration>();
    made->calibration = ldso::read_camera_calibration(file);
    const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
    if (photometric != 0) ldso::read_photometric_calibration(folder, made->calibration);
    return made.release();
  });
}

ldso_calibration* ldso_calibration_pinhole(int width, int height, double fx, double fy, double cx, double cy) {
  return guarded<ldso_calibration*>(nullptr, [&] {
    auto made = std::make_unique<ldso_calibration>();
    made->calibration.camera = {ldso::CameraModelKind::kPinhole, width, height, fx, fy, cx, cy, {}};
    made->calibration.description = "made in C";
    return made.release();
  });
}

ldso_status ldso_calibration_write(const ldso_calibration* calibration, const char* path) {
  return guarded(LDSO_ERROR, [&] {
    require(calibration, "calibration");
    require(path, "path");
    ldso::write_file(path, ldso::camera_file_text(calibration->calibration));
    return LDSO_OK;
  });
}

void ldso_calibration_free(ldso_calibration* calibration) { delete calibration; }

ldso_settings* ldso_settings_new(void) {
  return guarded<ldso_settings*>(nullptr, [] { return std::make_unique<ldso_settings>().release(); });
}

ldso_status ldso_settings_set(ldso_settings* settings, const char* key, const char* value) {
  return guarded(LDSO_ERROR, [&] {
    require(settings, "settings");
    require(key, "key");
    require(value, "value");
    ldso::set_setting(settings->settings, key, value);
    return LDSO_OK;
  });
}

ldso_status ldso_settings_read(ldso_settings* settings, const char* path) {
  return guarded(LDSO_ERROR, [&] {
    require(settings, "settings");
    require(path, "path");
    ldso::read_settings(path, settings->settings);
    return LDSO_OK;
  });
}

void ldso_settings_free(ldso_settings* settings) { delete settings; }
}
