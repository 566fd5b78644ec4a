#pragma once

namespace ldso {

/// What OpenCV holds for the whole process and what is therefore the program's to decide, not a library's: no threads
/// of its own, which would only compete with ours, and no messages, for it tries one codec library after the other and
/// prints what each of them says. To be called first of all.
void set_up_opencv();

}  // namespace ldso
