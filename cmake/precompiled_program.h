// The same for the commands, whose sources take longest for these two libraries.
#include <CLI/CLI.hpp>

#include "precompiled_json.h"
