#include <firn/io/axes.h>

namespace firn {
namespace {

/// Component i of the turned vector is sign[i] times component from[i].
struct Turn {
  int from[3];
  int sign[3];
};

constexpr Turn kNone = {{0, 1, 2}, {1, 1, 1}};
constexpr Turn kToZ = {{0, 2, 1}, {1, -1, 1}};
constexpr Turn kToY = {{0, 2, 1}, {1, 1, -1}};

constexpr const Turn& turn_of(UpAxis from, UpAxis to) {
  if (from == to) return kNone;
  return to == UpAxis::z ? kToZ : kToY;
}

/// Not -v: zero stays plain zero.
template <class T>
T with_sign(T v, int sign) {
  return sign > 0 ? v : T(0) - v;
}

template <class T>
void turn_vectors(std::vector<T>& values, const Turn& turn) {
  for (std::size_t i = 0; i + 2 < values.size(); i += 3) {
    const T old[3] = {values[i], values[i + 1], values[i + 2]};
    for (std::size_t c = 0; c < 3; ++c) values[i + c] = with_sign(old[turn.from[c]], turn.sign[c]);
  }
}

template <class T>
void turn_matrices(std::vector<T>& values, const Turn& turn) {
  for (std::size_t i = 0; i + 8 < values.size(); i += 9) {
    T old[9];
    for (std::size_t c = 0; c < 9; ++c) old[c] = values[i + c];
    for (std::size_t r = 0; r < 3; ++r) {
      for (std::size_t c = 0; c < 3; ++c) {
        values[i + 3 * r + c] = with_sign(old[3 * turn.from[r] + turn.from[c]], turn.sign[r] * turn.sign[c]);
      }
    }
  }
}

}  // namespace

Vec3d turned(const Vec3d& x, UpAxis from, UpAxis to) {
  const Turn& turn = turn_of(from, to);
  Vec3d result;
  for (int i = 0; i < 3; ++i) result[i] = with_sign(x[turn.from[i]], turn.sign[i]);
  return result;
}

void turn_up(Snapshot& snapshot, UpAxis from, UpAxis to) {
  if (from == to) return;
  const Turn& turn = turn_of(from, to);
  for (SnapshotColumn& column : snapshot.columns) {
    std::visit(
        [&](auto& values) {
          if (column.components == 3) turn_vectors(values, turn);
          if (column.components == 9) turn_matrices(values, turn);
        },
        column.values);
  }
}

}  // namespace firn
