#pragma once
// `ldso vocab`: trains, converts and describes vocabularies for place recognition.

#include <CLI/CLI.hpp>

namespace ldso {

void add_vocab_command(CLI::App& app);

}  // namespace ldso
