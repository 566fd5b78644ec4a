// Settings as YAML.

#include "fuzz_target.h"
#include "io/settings/settings_json.h"
#include "ldso/io/settings_file.h"

using namespace ldso;

LDSO_FUZZ_TARGET(settings_yaml) {
  Settings settings;
  if (!fuzz::succeeds([&] { read_settings(fuzz::scratch_file("settings.yaml", input), settings); })) return;
  fuzz::succeeds([&] { settings.validate(); });
  const auto path = fuzz::scratch_folder() / "again.yaml";
  write_settings(path, settings);
  Settings again;
  read_settings(path, again);
  fuzz::expect(settings_to_json(again) == settings_to_json(settings), "written settings read back as they were");
}
