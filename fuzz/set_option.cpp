// KEY=VALUE as `--set` takes it.

#include "fuzz_target.h"
#include "io/settings/settings_json.h"
#include "io/text/utf8.h"
#include "ldso/io/settings_file.h"

using namespace ldso;

LDSO_FUZZ_TARGET(set_option) {
  const std::string text(input);
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) return;
  Settings settings;
  if (!fuzz::succeeds([&] { set_setting(settings, text.substr(0, equals), text.substr(equals + 1)); })) return;
  fuzz::succeeds([&] { settings.validate(); });
  if (!is_utf8(text)) return;  // The name of a file, which YAML cannot hold as it is.
  const auto path = fuzz::scratch_folder() / "set.yaml";
  write_settings(path, settings);
  Settings again;
  read_settings(path, again);
  fuzz::expect(settings_to_json(again) == settings_to_json(settings), "a setting reads back as it was set");
}
