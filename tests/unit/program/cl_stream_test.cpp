// CL files are read line by line; what a line costs is in nc_stream_test.cpp.
#include "unit/program/cl_support.h"

namespace swarf::program {
namespace {

TEST(ClStream, TheFileGivesWhatTheTextGives) {
  for (const char* name : {"simple_block.cls", "coremill.cls", "Plane_1.cldata"}) {
    const std::string path = project_file(std::string("assets/programs/stepnode/") + name);
    const ClProgram file = load_cl(path), text = read_cl_clean(read_file(path), {});
    ASSERT_EQ(file.moves.size(), text.moves.size());
    EXPECT_EQ(file.motions, static_cast<long>(file.moves.size()));
    for (size_t i = 0; i < file.moves.size(); ++i)
      ASSERT_EQ(file.moves[i].to.tip_W, text.moves[i].to.tip_W) << name << " move " << i;
    EXPECT_EQ(file.notes.size(), text.notes.size());
  }
}

}  // namespace
}  // namespace swarf::program
