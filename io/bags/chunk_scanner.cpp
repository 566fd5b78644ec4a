#include "io/bags/chunk_scanner.h"

#include <optional>
#include <utility>

#include "ldso/error.h"

namespace ldso {

BagIndex ChunkScanner::scan(std::uint64_t first_record) {
  std::uint64_t offset = first_record;
  try {
    while (!is_at_end(offset)) offset = read_record(offset);
    end_chunk();
  } catch (const Error&) {
    end_cut_off(offset);
  }
  while (const std::optional<std::uint32_t> chunk = index_.chunk_of_unknown()) find_connections(*chunk);
  return std::move(index_);
}

void ChunkScanner::begin_chunk(const BagChunk& chunk, const std::string& packing) {
  end_chunk();
  has_index_ = false;
  index_.chunks.push_back(chunk);
  if (const std::optional<Packing> known = packing_of(packing)) {
    index_.chunks.back().packing = *known;
    return;
  }
  index_.chunks.back().size = 0;
  if (!said_.empty()) return;
  say_damaged(last_chunk(), "it is packed as '" + packing + "'; none, bz2, lz4 and zstd are read");
}

void ChunkScanner::end_chunk() {
  if (has_index_ || index_.chunks.empty()) return;
  has_index_ = true;
  look_through(last_chunk(), true);
}

/// Of the last chunk's index a part may be missing.
void ChunkScanner::end_cut_off(std::uint64_t offset) {
  index_.warnings.push_back(where_ + ": the bag is cut off or damaged at byte " + std::to_string(offset) + " of " +
                            std::to_string(file_.size()) + "; what can be read before is used");
  index_.forget_last_chunk();
  has_index_ = false;
  end_chunk();
}

void ChunkScanner::find_connections(std::uint32_t chunk) {
  look_through(chunk, false);
  // What the chunk with its first message does not name either is nobody's.
  for (auto& [connection, messages] : index_.messages) {
    if (!index_.connections.contains(connection) && !messages.empty() && messages.front().chunk == chunk)
      messages.clear();
  }
}

void ChunkScanner::look_through(std::uint32_t chunk, bool with_messages) {
  try {
    const Unpacked records = read_chunk(file_, index_.chunks[chunk]);
    if (!records.problem.empty()) say_damaged(chunk, records.problem);
    for (WireReader reader(records.bytes, where_); reader.remaining() > 0;)
      read_record_of_chunk(reader, chunk, with_messages);
  } catch (const Error& error) {
    say_damaged(chunk, error.what());
  }
}

void ChunkScanner::say_damaged(std::uint32_t chunk, const std::string& problem) {
  if (!said_.insert(chunk).second) return;
  index_.warnings.push_back(where_ + ": of chunk " + std::to_string(chunk) + " not all can be read (" + problem + ")");
}

}  // namespace ldso
