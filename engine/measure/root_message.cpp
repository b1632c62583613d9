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

/// Calls number(x) and place(x) for all that a part of a region holds, in one order for both ways.
template <typename Part, typename Number, typename Place>
void each_field_of_part(Part& part, const Number& number, const Place& place) {
  number(part.area_mm2);
  number(part.volume_mm3);
  number(part.worst_mm);
  place(part.place);
  number(part.block);
}

/// The same of a piece at the rim.
template <typename Rim, typename Number, typename Place>
void each_field_of_rim(Rim& rim, const Number& number, const Place& place) {
  place(rim.disc.centre);
  number(rim.disc.radius);
  number(rim.part);
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
  number(result.cut_short);
}

}  // namespace

void add_result(const RootResult& result, BytesWriter& out) {
  const auto number = [&](const auto& x) { out.add(x); };
  const auto place = [&](const Vec3& x) { add_vec(x, out); };
  each_field_of_result(result, number, place);
  for (const RootRegions* regions : {&result.gouges, &result.excesses}) {
    out.add(regions->parts.size());
    for (const RegionPart& part : regions->parts) each_field_of_part(part, number, place);
    out.add(regions->rim.size());
    for (const RootRegions::Rim& rim : regions->rim) each_field_of_rim(rim, number, place);
  }
  out.add_list(result.open);
}

RootResult get_result(BytesReader& in) {
  RootResult result;
  const auto number = [&](auto& x) { x = in.get<std::remove_reference_t<decltype(x)>>(); };
  const auto place = [&](Vec3& x) { x = get_vec(in); };
  each_field_of_result(result, number, place);
  for (RootRegions* regions : {&result.gouges, &result.excesses}) {
    regions->parts.resize(in.get<size_t>());
    for (RegionPart& part : regions->parts) each_field_of_part(part, number, place);
    regions->rim.resize(in.get<size_t>());
    for (RootRegions::Rim& rim : regions->rim) each_field_of_rim(rim, number, place);
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
  std::vector<RootResult> results(request.count);
  parallel_chunks(results.size(), 1, [&](size_t n, size_t) {
    results[n] = prove_root(input_, roots_->index, roots_->cells[request.roots[n]], request.budget);
  });
  BytesWriter out;
  for (const RootResult& result : results) add_result(result, out);
  return out.take();
}

}  // namespace swarf::measure
