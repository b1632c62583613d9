// The stock of a movie: what is made again and measured from frame to frame, and that it is as if made at
// once.
#include "reports/movie_stock.h"

#include <gtest/gtest.h>

#include <memory>

#include "base/progress.h"
#include "sim/simulation.h"

namespace swarf::reports {
namespace {

/// A ball's rows on the top of a block that is given as a mesh, cut and measured.
struct MeshRun {
  sim::Job job = sim::load_job(SWARF_SOURCE_DIR "/scenes/exact_scallop_mesh/scene.toml",
                               {"stock.voxel_mm=0.4", "movie.voxel_mm=0.4"});
  Progress progress;
  sim::Result result = sim::simulate(job, {}, progress);
  FinishedRun run{job, *result.main.cycles, *result.stock, result.main.dexels, *result.main.carried};

  MeshRun() { run.rays = &result.main.rays; }
};

constexpr size_t kFrames = 60;

TEST(MovieStock, AFrameMeasuresWhatHasBecomeFinishedAndIsColouredAsIfAtOnce) {
  const MeshRun mesh;
  MovieStock at_once(mesh.run, sim::MovieColours::kDeviation),
      by_frames(mesh.run, sim::MovieColours::kDeviation);
  motion::CycleReader reader(mesh.run.cycles);
  const size_t last = mesh.run.cycles.size() - 1;
  at_once.advance(reader.at(last));
  size_t most = 0;
  for (size_t f = 0; f <= kFrames; ++f) {
    const size_t before = by_frames.vertices_measured();
    by_frames.advance(reader.at(last * f / kFrames));
    if (f > 0) most = std::max(most, by_frames.vertices_measured() - before);
  }
  ASSERT_GT(at_once.vertices_measured(), 1000U);
  // Vertices beside the tool move until their cells are finished; the rest is measured once.
  EXPECT_LE(by_frames.vertices_measured(), 2 * at_once.vertices_measured());
  EXPECT_LE(most, at_once.vertices_measured() / 10);
  ASSERT_EQ(by_frames.state().size(), at_once.state().size());
  for (size_t i = 0; i < at_once.state().size(); ++i) {
    ASSERT_EQ(by_frames.state()[i] == nullptr, at_once.state()[i] == nullptr) << i;
    if (at_once.state()[i] == nullptr) continue;
    EXPECT_EQ(by_frames.state()[i]->positions, at_once.state()[i]->positions) << i;
    EXPECT_EQ(by_frames.state()[i]->colours, at_once.state()[i]->colours) << i;
  }
}

}  // namespace
}  // namespace swarf::reports
