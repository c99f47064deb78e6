// EIGEN_FUNCTORS_PLUGIN, which Eigen includes in its inner namespace before any matrix: selection by lists of
// indices, as Eigen has it since 3.4. Reading copies; writing is assignment, +=, -= and setZero().
}  // namespace internal

struct AllIndices {};
static constexpr AllIndices all{};

/// Rows and columns of a matrix, to be written.
template <typename Matrix>
class Selection {
 public:
  using Indices = std::vector<Index>;

  Selection(Matrix& matrix, const Indices& rows, const Indices& columns)
      : matrix_(matrix), rows_(rows), columns_(columns) {}

  template <typename Values>
  void operator=(const Values& values) {
    const auto evaluated = values.eval();
    write([&](Index row, Index column, auto& element) { element = evaluated(row, column); });
  }

  template <typename Values>
  void operator+=(const Values& values) {
    const auto evaluated = values.eval();
    write([&](Index row, Index column, auto& element) { element += evaluated(row, column); });
  }

  template <typename Values>
  void operator-=(const Values& values) {
    *this += -values;
  }

  /// Reading what could be written: a copy.
  template <int Rows, int Columns>
  operator Eigen::Matrix<typename Matrix::Scalar, Rows, Columns>() const {
    const Matrix& matrix = matrix_;
    return matrix(rows_, columns_);
  }

  void setZero() {
    write([](Index, Index, auto& element) { element = 0; });
  }

 private:
  template <typename Write>
  void write(const Write& one) {
    for (std::size_t j = 0; j < columns_.size(); ++j) {
      for (std::size_t i = 0; i < rows_.size(); ++i) {
        one(static_cast<Index>(i), static_cast<Index>(j), matrix_.coeffRef(rows_[i], columns_[j]));
      }
    }
  }

  Matrix& matrix_;
  Indices rows_;
  Indices columns_;
};

namespace internal {
