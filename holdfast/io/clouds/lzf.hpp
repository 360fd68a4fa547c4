#pragma once

#include <string>
#include <string_view>

namespace holdfast::io::clouds {

/// Unpacks LZF data (the compression of PCD's binary_compressed) that must become exactly `size`
/// bytes. False for data that is damaged or of another size; `out` is then undefined.
bool lzf_decompress(std::string_view packed, std::size_t size, std::string& out);

}  // namespace holdfast::io::clouds
