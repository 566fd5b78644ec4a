#include "viewer/recording/recording_file.h"

#include "io/images/image_file.h"
#include "ldso/error.h"
#include "util/whole_file.h"

namespace ldso {

void read_recording(const std::filesystem::path& path, LiveMap& map) {
  const Bytes bytes = read_bytes(path);
  const std::vector<protocol::Message> messages = protocol::split(bytes, path.string());
  if (messages.empty() || messages.front().type != protocol::MessageType::kHello) {
    throw Error(path.string(), "it is no recording of ldso", "give one that `ldso run` wrote");
  }
  protocol::Hello hello = protocol::decode_hello(messages.front().payload, path.string());
  hello.mode = protocol::Mode::kReplay;
  hello.has_control = false;
  map.start(hello);
  for (std::size_t i = 1; i < messages.size(); ++i) {
    const std::span<const std::uint8_t> whole = protocol::whole(messages[i]);
    map.add_message(Bytes(whole.begin(), whole.end()));
  }
}

void write_recording(const std::filesystem::path& path, const Bytes& recording) {
  write_file(path, {reinterpret_cast<const char*>(recording.data()), recording.size()});
}

}  // namespace ldso
