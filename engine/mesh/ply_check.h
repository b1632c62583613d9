// Whether a PLY file is whole, asked before assimp reads it: at a missing end it would wait for ever.
#pragma once

#include <string>

namespace swarf::mesh {

/// "" when the header is complete and the body holds everything that it announces; else the reason why not.
std::string check_ply_whole(const std::string& path);

}  // namespace swarf::mesh
