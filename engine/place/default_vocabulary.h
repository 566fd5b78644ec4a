#pragma once

// The vocabulary that comes with the library: built into it, so there is no file to find.

#include "place/vocabulary.h"

namespace ldso {

/// Takes a few tens of milliseconds; keep it. How it was made: data/README.md.
Vocabulary default_vocabulary();

}  // namespace ldso
