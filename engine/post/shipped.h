// The posts that come with the program: assets/posts/*.toml.
#pragma once

#include <string>
#include <vector>

namespace swarf::post {

/// Names without ending, sorted: "fanuc". Empty where the program stands without its files.
std::vector<std::string> shipped_posts();
/// "fanuc, haas, heidenhain, linuxcnc, mazak, siemens".
std::string shipped_list();
/// The file that a flag means: `written` itself where it is a path (it has a slash or ends in .toml), else
/// the shipped post of that name; "" where none is called so.
std::string post_file(const std::string& written);

}  // namespace swarf::post
