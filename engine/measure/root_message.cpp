#include "measure/root_message.h"

#include "base/parallel.h"
#include "measure/dealt_roots.h"

namespace swarf::measure {
namespace {

void add_vec(const Vec3& v, BytesWriter& out) {
  for (int i = 0; i < 3; ++i) out.add(v[i]);
}
Vec3 get_vec(BytesReader& in) {
  Vec3 v;
  for (int i = 0; i < 3; ++i) v[i] = in.get<double>();
  return v;
}

/// Calls number(x) and place(x) for all that a piece holds, in one order for both ways.
template <typename Piece, typename Number, typename Place>
void each_field_of_piece(Piece& piece, const Number& number, const Place& place) {
  place(piece.centre);
  number(piece.radius);
  number(piece.area_mm2);
  number(piece.volume_mm3);
  number(piece.worst_mm);
  place(piece.place);
  number(piece.block);
}

/// The same of a result, but for its lists.
template <typename Result, typename Number, typename Place>
void each_field_of_result(Result& result, const Number& number, const Place& place) {
  number(result.gouge);
  number(result.excess);
  number(result.scallop);
  place(result.gouge_at);
  place(result.excess_at);
  place(result.scallop_at);
  number(result.gouge_found);
  number(result.excess_found);
  place(result.gouge_bottom);
  place(result.excess_top);
  number(result.above_found);
  place(result.above_top);
  number(result.gouge_block);
  number(result.excess_block);
  number(result.cells);
  number(result.work);
  number(result.broken);
}

}  // namespace

void add_result(const RootResult& result, BytesWriter& out) {
  const auto number = [&](const auto& x) { out.add(x); };
  const auto place = [&](const Vec3& x) { add_vec(x, out); };
  each_field_of_result(result, number, place);
  for (const auto* pieces : {&result.gouges, &result.excesses}) {
    out.add(pieces->size());
    for (const RegionPiece& piece : *pieces) each_field_of_piece(piece, number, place);
  }
  out.add_list(result.open);
}

RootResult get_result(BytesReader& in) {
  RootResult result;
  const auto number = [&](auto& x) { x = in.get<std::remove_reference_t<decltype(x)>>(); };
  const auto place = [&](Vec3& x) { x = get_vec(in); };
  each_field_of_result(result, number, place);
  for (auto* pieces : {&result.gouges, &result.excesses}) {
    pieces->resize(in.get<size_t>());
    for (RegionPiece& piece : *pieces) each_field_of_piece(piece, number, place);
  }
  result.open = in.get_list<RootResult::Open>();
  return result;
}

struct RootProver::Roots {
  std::vector<RootCell> cells;
  SweepIndex index;
};

RootProver::RootProver(const CertificateInput& input)
    : input_(input),
      roots_(std::make_unique<const Roots>(
          Roots{root_cells(input.field, root_size(input.field)), SweepIndex(input.sweeps, input.cutters)})) {}
RootProver::~RootProver() = default;

Bytes RootProver::prove(BytesReader& in) const {
  const auto request = in.get<RootRequest>();
  std::vector<RootResult> results(request.end - request.first);
  parallel_chunks(results.size(), 1, [&](size_t n, size_t) {
    results[n] = prove_root(input_, roots_->index, roots_->cells[request.first + n], request.budget);
  });
  BytesWriter out;
  for (const RootResult& result : results) add_result(result, out);
  return out.take();
}

}  // namespace swarf::measure
