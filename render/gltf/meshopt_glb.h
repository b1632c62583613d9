// EXT_meshopt_compression: the buffers of a .glb encoded by meshoptimizer.
#pragma once

#include <string>

namespace swarf::render {

/// Bits of each component of a normal's octahedral form: it turns by at most 0.07 degrees.
inline constexpr int kNormalBits = 12;

/// The same .glb with every buffer view encoded: triangles and lines by the index codecs, all else by the
/// vertex codec, normalised 16-bit normals through the octahedral filter of kNormalBits. All but these
/// normals is kept to the bit; triangles keep their winding, not which corner comes first. A reader needs the
/// extension: it is required, and the file holds nothing for those without it.
std::string meshopt_compressed(const std::string& glb);

}  // namespace swarf::render
