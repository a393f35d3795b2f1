#include <firn/state/grid.h>
#include <firn/transfer/reference.h>

namespace firn {
namespace {

/// A node that a particle touches: number of the collider that it is hidden behind, and its index.
template <int dim>
using NodeKey = std::pair<int, Index<dim>>;

/// body(node, w_ip, grad w_ip, x_i - x_p, n) for the nodes that particle p touches, with the normal of the wall
/// between.
template <class Real, int dim, class Body>
void for_each_node(const Particles<Real, dim>& particles, std::size_t p, double dx, Kernel kernel,
                   const Period<dim>& period, const HiddenBehind<dim>& behind, const Body& body) {
  const int degree = static_cast<int>(kernel) + 1;
  const Index<dim> cell = cell_of_key<dim>(particles.cell(p));
  const Vec<double, dim> x = particles.position(p, dx, kernel);
  double s[dim], N[dim][4], dN[dim][4];
  for (int d = 0; d < dim; ++d) {
    s[d] = static_cast<double>(particles.real(Field::offset, d)[p]);
    for (int a = 0; a <= degree; ++a) {
      N[d][a] = b_spline(degree, a, s[d]);
      dN[d][a] = b_spline_derivative(degree, a, s[d]) / dx;
    }
  }
  for (int n = 0; n < power(degree + 1, dim); ++n) {
    Index<dim> i = {};
    Vec<double, dim> r, grad_w = constant_vector<double, dim>(1);
    double w = 1;
    for (int d = 0, rest = n; d < dim; ++d, rest /= degree + 1) {
      const int a = rest % (degree + 1);
      const auto axis = static_cast<std::size_t>(d);
      i[axis] = cell[axis] + a;
      if (period[axis] > 0) i[axis] = (i[axis] % period[axis] + period[axis]) % period[axis];
      r[d] = dx * (a - cell_offset(kernel) - s[d]);
      w *= N[d][a];
      for (int e = 0; e < dim; ++e) grad_w[e] *= e == d ? dN[d][a] : N[d][a];
    }
    Vec<double, dim> n_wall = {};
    const int collider = behind ? behind(x, x + r, n_wall) : -1;
    body(NodeKey<dim>{collider, i}, w, grad_w, r, n_wall);
  }
}

template <class Real, int dim>
Vec<double, dim> vector(const Particles<Real, dim>& particles, Field field, std::size_t p) {
  Vec<double, dim> v;
  for (int i = 0; i < dim; ++i) v[i] = static_cast<double>(particles.real(field, i)[p]);
  return v;
}

template <class Real, int dim>
void set_matrix(Particles<Real, dim>& particles, Field field, std::size_t p, const Mat<double, dim>& A) {
  for (int e = 0; e < dim * dim; ++e) particles.real(field, e)[p] = static_cast<Real>(A.e[e]);
}

template <class Real, int dim>
Mat<double, dim> affine_matrix(const Particles<Real, dim>& particles, std::size_t p) {
  Mat<double, dim> C;
  for (int e = 0; e < dim * dim; ++e) C.e[e] = static_cast<double>(particles.real(Field::affine, e)[p]);
  return C;
}

template <class Real, int dim>
Mat<double, dim> kirchhoff(const Particles<Real, dim>& particles, std::size_t p) {
  const auto tau = [&](int c) { return static_cast<double>(particles.real(Field::stress, c)[p]); };
  if constexpr (dim == 3) {
    return {{tau(0), tau(3), tau(4), tau(3), tau(1), tau(5), tau(4), tau(5), tau(2)}};
  } else {
    return {{tau(0), tau(3), tau(3), tau(1)}};
  }
}

/// D_p of APIC, m^2 (Jiang et al. 2016, after eq. 174).
double inertia(Kernel kernel, double dx) { return kernel == Kernel::cubic ? dx * dx / 3 : dx * dx / 4; }

}  // namespace

double b_spline(int degree, int a, double s) {
  if (degree == 0) return a == 0 ? 1 : 0;
  return ((s + degree - a) * b_spline(degree - 1, a - 1, s) + (a + 1 - s) * b_spline(degree - 1, a, s)) / degree;
}

double b_spline_derivative(int degree, int a, double s) {
  return b_spline(degree - 1, a - 1, s) - b_spline(degree - 1, a, s);
}

template <class Real, int dim>
void reference_scatter(const Particles<Real, dim>& particles, double dx, double dt, const TransferSettings& settings,
                       const Period<dim>& period, const HiddenBehind<dim>& behind, ReferenceGrid<dim>& grid) {
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const double m = particles.mass(p);
    const double V0 = static_cast<double>(particles.rest_volume(p));
    const Vec<double, dim> v = vector(particles, Field::velocity, p);
    const Vec<double, dim> b =
        particles.has(Field::acceleration) ? vector(particles, Field::acceleration, p) : Vec<double, dim>{};
    const Mat<double, dim> C = settings.affine * affine_matrix(particles, p);
    const Mat<double, dim> tau = kirchhoff(particles, p);
    for_each_node<Real, dim>(particles, p, dx, settings.kernel, period, behind,
                             [&](const NodeKey<dim>& i, double w, const Vec<double, dim>& grad_w,
                                 const Vec<double, dim>& r, const Vec<double, dim>& n) {
                               ReferenceNode<dim>& node = grid[i];
                               const Vec<double, dim> before = (w * m) * (v + C * r);
                               const Vec<double, dim> force = settings.form == Form::mls
                                                                  ? (-V0 / inertia(settings.kernel, dx) * w) * (tau * r)
                                                                  : -V0 * (tau * grad_w);
                               node.mass += w * m;
                               node.wall_normal += (w * m) * n;
                               node.momentum_before += before;
                               node.momentum += before + (w * m * dt) * b + dt * force;
                             });
  }
}

template <class Real, int dim>
std::vector<Vec<double, dim>> reference_gather(Particles<Real, dim>& particles, double dx,
                                               const TransferSettings& settings, const Period<dim>& period,
                                               const HiddenBehind<dim>& behind, const ReferenceGrid<dim>& grid) {
  std::vector<Vec<double, dim>> moves_with(particles.size());
  for (std::size_t p = 0; p < particles.size(); ++p) {
    Vec<double, dim> pic = {}, flip = vector(particles, Field::velocity, p);
    Mat<double, dim> B = {}, grad_v = {};
    for_each_node<Real, dim>(particles, p, dx, settings.kernel, period, behind,
                             [&](const NodeKey<dim>& i, double w, const Vec<double, dim>& grad_w,
                                 const Vec<double, dim>& r, const Vec<double, dim>&) {
                               const ReferenceNode<dim>& node = grid.at(i);
                               pic += w * node.velocity;
                               flip += w * node.velocity_change;
                               B = B + w * outer(node.velocity, r);
                               grad_v = grad_v + outer(node.velocity, grad_w);
                             });
    const Vec<double, dim> v = (1 - settings.flip) * pic + settings.flip * flip;
    for (int i = 0; i < dim; ++i) particles.real(Field::velocity, i)[p] = static_cast<Real>(v[i]);
    set_matrix(particles, Field::affine, p,
               settings.kernel == Kernel::linear ? grad_v : (1 / inertia(settings.kernel, dx)) * B);
    if (particles.has(Field::grad_v)) set_matrix(particles, Field::grad_v, p, grad_v);
    moves_with[p] = pic;
  }
  return moves_with;
}

#define FIRN_INSTANTIATE(Real, dim)                                                                                \
  template void reference_scatter<Real, dim>(const Particles<Real, dim>&, double, double, const TransferSettings&, \
                                             const Period<dim>&, const HiddenBehind<dim>&, ReferenceGrid<dim>&);   \
  template std::vector<Vec<double, dim>> reference_gather<Real, dim>(                                              \
      Particles<Real, dim>&, double, const TransferSettings&, const Period<dim>&, const HiddenBehind<dim>&,        \
      const ReferenceGrid<dim>&);
FIRN_INSTANTIATE(float, 2)
FIRN_INSTANTIATE(float, 3)
FIRN_INSTANTIATE(double, 2)
FIRN_INSTANTIATE(double, 3)
#undef FIRN_INSTANTIATE

}  // namespace firn
