#pragma once

#include <algorithm>
#include <cstddef>
#include <exception>
#include <functional>
#include <new>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>

#include "util/bounded_queue.h"
#include "util/out_of_memory.h"

namespace ldso {

/// Decodes (and, if `produce` does so, preprocesses) frames ahead on another thread and hands them over in order.
/// A frame that cannot be read does not end the sequence: its item carries the reason instead of a value.
template <class T>
class PrefetchingReader {
 public:
  struct Item {
    int index = 0;
    std::optional<T> value;
    std::string error;  ///< Why there is no value.
    /// Memory that could not be had: no fault of this frame.
    std::optional<OutOfMemory> out_of_memory;
  };

  /// Calls produce(0), ..., produce(count - 1) on one thread of its own, at most `ahead` items before they are wanted.
  PrefetchingReader(int count, std::function<T(int)> produce, int ahead = 4)
      : queue_(static_cast<std::size_t>(std::max(ahead, 1))),
        thread_([this, count, produce = std::move(produce)](const std::stop_token& stop) {
          for (int i = 0; i < count && !stop.stop_requested(); ++i) {
            if (!queue_.push(make_item(i, produce))) return;
          }
          queue_.close();
        }) {}

  /// Stops after the item that is being produced.
  ~PrefetchingReader() {
    thread_.request_stop();
    queue_.close();
  }
  PrefetchingReader(const PrefetchingReader&) = delete;
  PrefetchingReader& operator=(const PrefetchingReader&) = delete;

  /// The next item, waiting for it if need be; nothing after the last one. Throws OutOfMemory if there was none for it.
  std::optional<Item> next() {
    std::optional<Item> item = queue_.pop();
    if (item && item->out_of_memory) throw OutOfMemory(*item->out_of_memory);
    return item;
  }

 private:
  static Item make_item(int index, const std::function<T(int)>& produce) {
    Item item{index, std::nullopt, "", std::nullopt};
    try {
      item.value.emplace(produce(index));
    } catch (const OutOfMemory& known) {
      item.out_of_memory = known;
    } catch (const std::bad_alloc&) {
      item.out_of_memory.emplace("reading frame " + std::to_string(index));
    } catch (const std::exception& error) {
      item.error = error.what();
    }
    return item;
  }

  BoundedQueue<Item> queue_;
  std::jthread thread_;  ///< Declared last: it uses the queue and is joined first.
};

}  // namespace ldso
