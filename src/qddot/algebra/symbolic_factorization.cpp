#include "qddot/algebra/symbolic_factorization.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <new>
#include <numeric>
#include <span>
#include <utility>

#include <suitesparse/cholmod.h>

namespace qddot {
namespace {

// The lower triangle of a graph, column by column, and the number of unknowns of each vertex.
struct Graph {
  std::vector<int> start, rows, unknowns;
};

// The graph of blocks. CHOLMOD merges supernodes of few vertices whatever zeros that adds.
Graph block_graph(const SymmetricMatrix& pattern) {
  const std::vector<int> first = block_starts(pattern);
  Graph graph;
  std::vector<int> vertex(pattern.rows());
  for (std::size_t v = 0; v + 1 < first.size(); ++v) {
    graph.unknowns.push_back(first[v + 1] - first[v]);
    std::fill(vertex.begin() + first[v], vertex.begin() + first[v + 1], static_cast<int>(v));
  }
  for (std::size_t v = 0; v + 1 < first.size(); ++v) {
    graph.start.push_back(static_cast<int>(graph.rows.size()));
    for (SymmetricMatrix::InnerIterator entry(pattern, first[v]); entry; ++entry) {
      const int i = vertex[entry.row()];
      if (std::ssize(graph.rows) == graph.start.back() || graph.rows.back() != i)
        graph.rows.push_back(i);
    }
  }
  graph.start.push_back(static_cast<int>(graph.rows.size()));
  return graph;
}

// The operations per vertex, with the order of minimum degree, from which nested dissection is
// tried too. The order with fewer entries in L is taken. Nested dissection takes the time of 2.4e5
// operations a vertex and saves a tenth of a factorisation, as measured. It gains nothing in the
// plane below 3000 nodes, and two thirds in space at 8000. So a hundred factorisations pay for it.
constexpr double worth_dissection = 2e4;

// CHOLMOD's workspace and its symbolic factor of a graph.
class Analysis {
 public:
  explicit Analysis(Graph& graph) {
    cholmod_start(&common_);
    common_.print = 0;  // failures are returned, not printed
    common_.supernodal = CHOLMOD_SUPERNODAL;
    common_.nmethods = 1;
    // Supernodes of up to 4, 8 and 16 vertices are merged if that adds few enough zeros. CHOLMOD's
    // own 4, 16 and 48 are for vertices of one unknown. Here they make a factorisation of a cloth
    // a twentieth longer, and one of a chain a third.
    common_.nrelax[1] = 8;
    common_.nrelax[2] = 16;
    cholmod_sparse view{};
    view.nrow = view.ncol = graph.unknowns.size();
    view.nzmax = graph.rows.size();
    view.p = graph.start.data();
    view.i = graph.rows.data();
    view.stype = -1;  // the lower triangle
    view.itype = CHOLMOD_INT;
    view.xtype = CHOLMOD_PATTERN;
    view.dtype = CHOLMOD_DOUBLE;
    view.sorted = view.packed = 1;
    const auto analyze = [&](int ordering) {
      common_.method[0].ordering = ordering;
      return cholmod_analyze(&view, &common_);
    };
    factor_ = analyze(CHOLMOD_AMD);
    const double entries = common_.lnz, vertices = static_cast<double>(view.nrow);
    const double unknowns = std::accumulate(graph.unknowns.begin(), graph.unknowns.end(), 0.0);
    if (factor_ && common_.fl * std::pow(unknowns / vertices, 3) > worth_dissection * vertices) {
      cholmod_factor* dissected = analyze(CHOLMOD_NESDIS);
      if (dissected && common_.lnz < entries) std::swap(factor_, dissected);
      cholmod_free_factor(&dissected, &common_);
    }
    if (!factor_) {
      cholmod_finish(&common_);
      throw std::bad_alloc();
    }
  }
  ~Analysis() {
    cholmod_free_factor(&factor_, &common_);
    cholmod_finish(&common_);
  }
  Analysis(const Analysis&) = delete;
  Analysis& operator=(const Analysis&) = delete;

  int supernodes() const { return static_cast<int>(factor_->nsuper); }
  const int* order() const { return static_cast<const int*>(factor_->Perm); }
  // Supernode s has the vertices first()[s] to first()[s + 1] and the rows, these included,
  // rows()[start()[s]] to rows()[start()[s + 1]].
  const int* first() const { return static_cast<const int*>(factor_->super); }
  const int* start() const { return static_cast<const int*>(factor_->pi); }
  const int* rows() const { return static_cast<const int*>(factor_->s); }

 private:
  cholmod_common common_{};
  cholmod_factor* factor_ = nullptr;
};

// The sum of of_pivot(r) over all pivots, r the rows below each.
template <class OfPivot>
double over_pivots(const SymbolicFactorization& symbolic, const OfPivot& of_pivot) {
  double sum = 0;
  for (const Supernode& node : symbolic.supernodes) {
    for (int p = 0; p < node.pivots; ++p) {
      sum += of_pivot(static_cast<double>(node.pivots - p - 1 + std::ssize(node.rows)));
    }
  }
  return sum;
}

bool same_column(const SymmetricMatrix& a, int i, int j) {
  const auto column = [&](int k) {
    return std::span(a.innerIndexPtr() + a.outerIndexPtr()[k],
                     a.innerIndexPtr() + a.outerIndexPtr()[k + 1]);
  };
  return std::ranges::equal(column(i), column(j));
}

}  // namespace

double SymbolicFactorization::entries() const {
  return over_pivots(*this, [](double rows) { return rows + 1; });
}

double SymbolicFactorization::operations() const {
  return over_pivots(*this, [](double rows) { return rows * (rows + 2); });
}

SymbolicFactorization analyse(const SymmetricMatrix& pattern) {
  if (pattern.rows() == 0) return {};  // CHOLMOD refuses an empty matrix
  Graph graph = block_graph(pattern);
  const int vertices = static_cast<int>(graph.unknowns.size());
  // METIS cuts the graph with random numbers of the process' one rand(), after setting its seed. In
  // two threads at once the order would depend on chance.
  static std::mutex one_at_a_time;
  const std::unique_lock lock(one_at_a_time);
  const Analysis analysis(graph);

  SymbolicFactorization result;
  // The first unknown of each vertex, as they were and in the new order.
  std::vector<int> before(vertices + 1), after(vertices + 1), supernode(pattern.rows());
  for (int v = 0; v < vertices; ++v) {
    before[v + 1] = before[v] + graph.unknowns[v];
    after[v + 1] = after[v] + graph.unknowns[analysis.order()[v]];
  }
  result.place.resize(pattern.rows());
  for (int v = 0; v < vertices; ++v) {
    for (int i = after[v]; i < after[v + 1]; ++i)
      result.place[before[analysis.order()[v]] + i - after[v]] = i;
  }
  for (int s = 0; s < analysis.supernodes(); ++s) {
    const int first = after[analysis.first()[s]], end = after[analysis.first()[s + 1]];
    Supernode node{first, end - first, -1, {}};
    for (int i = first; i < end; ++i) supernode[i] = s;
    for (int k = analysis.start()[s] + analysis.first()[s + 1] - analysis.first()[s];
         k < analysis.start()[s + 1]; ++k) {
      const int v = analysis.rows()[k];
      for (int i = after[v]; i < after[v + 1]; ++i) node.rows.push_back(i);
    }
    result.supernodes.push_back(std::move(node));
  }
  for (Supernode& node : result.supernodes) {
    if (!node.rows.empty()) node.parent = supernode[node.rows.front()];
  }
  return result;
}

std::vector<int> block_starts(const SymmetricMatrix& pattern) {
  const SymmetricMatrix whole = pattern.selfadjointView<Eigen::Lower>();
  const int n = static_cast<int>(pattern.rows());
  std::vector<int> starts;
  for (int j = 0; j < n; ++j) {
    if (j == 0 || j - starts.back() == most_block_unknowns || !same_column(whole, j - 1, j)) {
      starts.push_back(j);
    }
  }
  starts.push_back(n);
  return starts;
}

}  // namespace qddot
