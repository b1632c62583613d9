// Random programs: texts that must be read back exactly, and damaged ones that must never crash.
#include <fmt/format.h>

#include <utility>

#include "base/rng.h"
#include "surface/polynomial.h"
#include "unit/program/support.h"

namespace swarf::program::property_test {
namespace {

using surface::PolynomialSurface;

int random_int(Rng& rng, int low, int high) {
  return low + static_cast<int>(rng.next() % static_cast<uint64_t>(high - low + 1));
}

/// A net near a 100 mm square, so that the surface is regular.
std::vector<Vec3> random_net(Rng& rng, int degree_u, int degree_v) {
  std::vector<Vec3> net;
  for (int i = 0; i <= degree_u; ++i) {
    for (int j = 0; j <= degree_v; ++j) {
      const Vec3 square(100.0 * i / degree_u, 100.0 * j / degree_v, 0.0);
      net.push_back(square + Vec3{rng.uniform(-2, 2), rng.uniform(-2, 2), rng.uniform(-20, 20)});
    }
  }
  return net;
}

/// L70 to L79 of surface 1 with its coefficient blocks in random order.
std::string surface_text(Rng& rng, int data_kind, int degree_u, int degree_v, const std::vector<Vec3>& net,
                         int sign) {
  std::vector<std::string> blocks;
  for (int i = 0; i <= degree_u; ++i) {
    for (int j = 0; j <= degree_v; ++j) {
      const Vec3& c = net[static_cast<size_t>(i) * (degree_v + 1) + j];
      // 18 places after the point carry every double of this size to within 1e-18 mm.
      blocks.push_back(fmt::format("G10 L{} P1 I{} J{} X{:.18f} Y{:.18f} Z{:.18f}\n", data_kind, i, j, c.x(),
                                   c.y(), c.z()));
    }
  }
  std::string text = fmt::format("G10 L70 P1 Q{} R{}\n", degree_u, degree_v);
  for (size_t n = blocks.size(); n > 0; --n) {
    std::swap(blocks[n - 1], blocks[rng.next() % n]);
    text += blocks[n - 1];
  }
  return text + fmt::format("G10 L79 P1 D{}\n", sign);
}

/// Bernstein polynomial k of degree n.
double bernstein(int n, int k, double t) {
  double value = 1.0;
  for (int i = 1; i <= k; ++i) value *= (n - k + i) * t / i;
  for (int i = 0; i < n - k; ++i) value *= 1.0 - t;
  return value;
}

const PolynomialSurface& only_surface(const Program& program) {
  return dynamic_cast<const PolynomialSurface&>(*program.surfaces.at(0).surface);
}

TEST(SurfaceText, OfPowerCoefficientsInAnyOrderIsReadBack) {
  Rng rng(2026);
  for (int trial = 0; trial < 100; ++trial) {
    const int m = random_int(rng, 1, 6);
    const int n = random_int(rng, 1, 6);
    const int sign = random_int(rng, 0, 1) == 0 ? -1 : 1;
    const auto original = PolynomialSurface::from_bezier(m, n, random_net(rng, m, n), sign);
    const std::string text =
        with_modal_words(surface_text(rng, 71, m, n, original.coefficients(), sign) + "G06.4 P1 V0 F9\n");
    const Program program = parse_clean(text);
    ASSERT_EQ(program.surfaces.size(), 1U) << text;
    const PolynomialSurface& read = only_surface(program);
    ASSERT_EQ(read.degree_u(), m);
    ASSERT_EQ(read.degree_v(), n);
    EXPECT_EQ(read.outward_sign(), sign);
    for (size_t k = 0; k < read.coefficients().size(); ++k) {
      ASSERT_LT((read.coefficients()[k] - original.coefficients()[k]).norm(), 1e-12) << text;
    }
  }
}

TEST(SurfaceText, OfControlPointsInAnyOrderIsTheBezierSurface) {
  Rng rng(2027);
  for (int trial = 0; trial < 100; ++trial) {
    const int m = random_int(rng, 1, 4);
    const int n = random_int(rng, 1, 4);
    const std::vector<Vec3> net = random_net(rng, m, n);
    const std::string text = with_modal_words(surface_text(rng, 72, m, n, net, 1) + "G06.4 P1 V0 F9\n");
    const Program program = parse_clean(text);
    ASSERT_EQ(program.surfaces.size(), 1U) << text;
    for (int sample = 0; sample < 20; ++sample) {
      const double u = rng.uniform();
      const double v = rng.uniform();
      Vec3 expected = Vec3::Zero();
      for (int i = 0; i <= m; ++i) {
        for (int j = 0; j <= n; ++j)
          expected += bernstein(m, i, u) * bernstein(n, j, v) * net[static_cast<size_t>(i) * (n + 1) + j];
      }
      // 1e-12 of the surface's size, 100 mm.
      ASSERT_LT((program.surfaces[0].surface->point(u, v) - expected).norm(), 1e-10)
          << "u " << u << " v " << v << '\n'
          << text;
    }
  }
}

/// A program that was read, or at least one error: what every text must give.
void expect_answer(const std::string& text) {
  const Parsed parsed = parse(text);
  EXPECT_TRUE(parsed.diagnostics.has_errors() || !parsed.program.operations.empty()) << text;
  // With errors, the program means nothing.
  if (parsed.diagnostics.has_errors()) return;
  for (const Operation& operation : parsed.program.operations) {
    ASSERT_LT(static_cast<size_t>(operation.surface), parsed.program.surfaces.size()) << text;
    EXPECT_GT(operation.feed_mm_s, 0.0) << text;
    EXPECT_GT(operation.tool, 0) << text;
    EXPECT_GT(operation.spindle_rpm, 0.0) << text;
  }
  for (const Diagnostic& diagnostic : parsed.diagnostics.list())
    EXPECT_LE(diagnostic.where.line, 100) << text;
}

TEST(DamagedProgram, EveryPrefixOfTheDomeGivesAnAnswer) {
  const std::string dome = dome_text();
  for (size_t length = 0; length <= dome.size(); ++length) expect_answer(dome.substr(0, length));
}

std::string mutated(Rng& rng, std::string text) {
  const int changes = random_int(rng, 1, 4);
  for (int k = 0; k < changes && !text.empty(); ++k) {
    const size_t at = rng.next() % text.size();
    switch (random_int(rng, 0, 4)) {
      case 0:
        text[at] = static_cast<char>(rng.next() & 0xFF);
        break;
      case 1:
        text[at] = "GLPIJXYZQRDBEKFNMTS0123456789.-+%();\n"[rng.next() % 37];
        break;
      case 2:
        text.erase(at, 1 + rng.next() % 12);
        break;
      case 3:
        text.insert(at, text.substr(rng.next() % text.size(), rng.next() % 12));
        break;
      default:
        text.insert(at, std::string(rng.next() % 400, static_cast<char>('0' + rng.next() % 10)));
        break;
    }
  }
  return text;
}

TEST(DamagedProgram, RandomByteChangesGiveAnAnswer) {
  Rng rng(77);
  const std::string dome = dome_text();
  const std::string bezier = read_file(project_file("tests/data/programs/good/bezier_plane_inward.nc"));
  for (int trial = 0; trial < 10000; ++trial) expect_answer(mutated(rng, trial % 2 == 0 ? dome : bezier));
}

}  // namespace
}  // namespace swarf::program::property_test
