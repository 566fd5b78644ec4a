// The same for sources that read and write JSON.
#include <nlohmann/json.hpp>

#include "precompiled.h"
