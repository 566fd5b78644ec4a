#pragma once

#include <cstdint>
#include <set>
#include <string>

#include "io/bags/chunked_bag.h"

namespace ldso {

/// Walks once over the records of a file and notes where which message lies. It needs no index at the file's end: a
/// recording that was never closed has none, and one that is cut off has lost it.
class ChunkScanner {
 public:
  explicit ChunkScanner(const BagFile& file) : file_(file), where_(file.path().string()) {}
  virtual ~ChunkScanner() = default;
  ChunkScanner(const ChunkScanner&) = delete;
  ChunkScanner& operator=(const ChunkScanner&) = delete;

  /// From the first record on, as far as records can be read.
  BagIndex scan(std::uint64_t first_record);

 protected:
  /// Takes note of a record of the file; the offset of the next one. Throws Error if it is cut off or no record.
  virtual std::uint64_t read_record(std::uint64_t offset) = 0;
  /// The same of one in an unpacked chunk.
  virtual void read_record_of_chunk(WireReader& records, std::uint32_t chunk, bool with_messages) = 0;
  virtual bool is_at_end(std::uint64_t offset) const = 0;

  /// A chunk begins; `packing` as the file names it.
  void begin_chunk(const BagChunk& chunk, const std::string& packing);
  std::uint32_t last_chunk() const { return static_cast<std::uint32_t>(index_.chunks.size() - 1); }
  /// The index of the chunk that was begun last follows.
  void begin_index() { has_index_ = true; }

  const BagFile& file_;
  std::string where_;
  BagIndex index_;

 private:
  /// A chunk without an index is looked through itself.
  void end_chunk();
  void end_cut_off(std::uint64_t offset);
  void find_connections(std::uint32_t chunk);
  void look_through(std::uint32_t chunk, bool with_messages);
  void say_damaged(std::uint32_t chunk, const std::string& problem);

  bool has_index_ = true;
  std::set<std::uint32_t> said_;  ///< Damaged chunks.
};

}  // namespace ldso
