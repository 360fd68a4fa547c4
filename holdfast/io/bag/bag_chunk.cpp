#include "holdfast/io/bag/bag_chunk.hpp"

#include <bzlib.h>
#include <lz4frame.h>

#include <cassert>

namespace holdfast::io::bag {
namespace {

/// Frees what the libraries allocate, on every way out.
struct Bz2Stream {
  bz_stream stream{};
  bool ready = BZ2_bzDecompressInit(&stream, 0, 0) == BZ_OK;
  ~Bz2Stream() {
    if (ready) BZ2_bzDecompressEnd(&stream);
  }
};

struct Lz4Context {
  LZ4F_dctx* context = nullptr;
  bool ready = LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION)) == 0;
  ~Lz4Context() { LZ4F_freeDecompressionContext(context); }
};

Unpacked unpack_bz2(std::string_view packed, std::size_t size, Buffer& out) {
  Bz2Stream bz2;
  if (!bz2.ready) return Unpacked::kDamaged;
  bz2.stream.next_in = const_cast<char*>(packed.data());
  bz2.stream.avail_in = static_cast<unsigned>(packed.size());
  // A byte more than needed, so that the decoder goes on to the checksum.
  bz2.stream.next_out = out.make_room(size + 1);
  bz2.stream.avail_out = static_cast<unsigned>(size + 1);
  const int code = BZ2_bzDecompress(&bz2.stream);
  const std::size_t done = size + 1 - bz2.stream.avail_out;
  if ((code != BZ_OK && code != BZ_STREAM_END) || done > size) return Unpacked::kDamaged;
  out.set_size(done);
  return done == size ? Unpacked::kWhole : Unpacked::kEndsEarly;
}

Unpacked unpack_lz4(std::string_view packed, std::size_t size, Buffer& out) {
  Lz4Context lz4;
  if (!lz4.ready) return Unpacked::kDamaged;
  char* target = out.make_room(size);
  std::size_t done = 0;
  while (true) {
    std::size_t produced = size - done;
    std::size_t consumed = packed.size();
    const std::size_t code =
        LZ4F_decompress(lz4.context, target + done, &produced, packed.data(), &consumed, nullptr);
    if (LZ4F_isError(code) != 0) return Unpacked::kDamaged;
    done += produced;
    packed.remove_prefix(consumed);
    if (code == 0 || (produced == 0 && consumed == 0)) break;
  }
  out.set_size(done);
  return done == size ? Unpacked::kWhole : Unpacked::kEndsEarly;
}

}  // namespace

char* Buffer::make_room(std::size_t size) {
  if (size > capacity_) {
    data_.reset(new char[size]);  // make_unique would clear it
    capacity_ = size;
  }
  return data_.get();
}

Compression parse_compression(std::string_view name) {
  if (name == "none") return Compression::kNone;
  if (name == "bz2") return Compression::kBz2;
  if (name == "lz4") return Compression::kLz4;
  return Compression::kUnknown;
}

Unpacked unpack_chunk(Compression compression, std::string_view packed, std::size_t size,
                      Buffer& out) {
  out.set_size(0);
  if (compression == Compression::kBz2) return unpack_bz2(packed, size, out);
  if (compression == Compression::kLz4) return unpack_lz4(packed, size, out);
  return Unpacked::kDamaged;
}

std::string pack_lz4(std::string_view bytes) {
  LZ4F_preferences_t preferences{};
  // What ROS's own LZ4 reader demands of a frame.
  preferences.frameInfo.blockMode = LZ4F_blockIndependent;
  preferences.frameInfo.blockSizeID = LZ4F_max256KB;
  preferences.frameInfo.contentChecksumFlag = LZ4F_contentChecksumEnabled;
  std::string packed(LZ4F_compressFrameBound(bytes.size(), &preferences), '\0');
  const std::size_t size =
      LZ4F_compressFrame(packed.data(), packed.size(), bytes.data(), bytes.size(), &preferences);
  assert(LZ4F_isError(size) == 0);  // the bound suffices, and there is no other cause
  packed.resize(size);
  return packed;
}

}  // namespace holdfast::io::bag
