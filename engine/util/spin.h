#pragma once

#if defined(__x86_64__) || defined(__i386__)
#include <immintrin.h>
#endif

#include <chrono>

namespace ldso {

/// Tells the processor that this thread but waits.
inline void pause_briefly() {
#if defined(__x86_64__) || defined(__i386__)
  _mm_pause();
#elif defined(__aarch64__)
  asm volatile("yield");
#endif
}

/// Looks out for a condition without sleeping, for a time in which another thread could hardly be woken up. Returns
/// when it holds or that time is over.
template <class Condition>
void spin_until(Condition holds) {
  constexpr std::chrono::microseconds kLongest(50);
  constexpr int kLooks = 16;  // From one look at the clock to the next.
  const auto end = std::chrono::steady_clock::now() + kLongest;
  do {
    for (int i = 0; i < kLooks; ++i) {
      if (holds()) return;
      pause_briefly();
    }
  } while (std::chrono::steady_clock::now() < end);
}

}  // namespace ldso
