// EIGEN_PLAINOBJECTBASE_PLUGIN, members of every matrix and vector: what Eigen has since 3.4.

Scalar* begin() {
  EIGEN_STATIC_ASSERT_VECTOR_ONLY(Derived)
  return data();
}

Scalar* end() {
  return begin() + this->size();
}

const Scalar* begin() const {
  EIGEN_STATIC_ASSERT_VECTOR_ONLY(Derived)
  return data();
}

const Scalar* end() const {
  return begin() + this->size();
}

using Base::operator();
using Indices = std::vector<Index>;

Matrix<Scalar, Dynamic, Dynamic> operator()(const Indices& rows, const Indices& columns) const {
  Matrix<Scalar, Dynamic, Dynamic> selected(rows.size(), columns.size());
  for (std::size_t j = 0; j < columns.size(); ++j) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      selected(static_cast<Index>(i), static_cast<Index>(j)) = coeff(rows[i], columns[j]);
    }
  }
  return selected;
}

Matrix<Scalar, Dynamic, ColsAtCompileTime> operator()(const Indices& rows, AllIndices) const {
  return (*this)(rows, upTo(cols()));
}

Matrix<Scalar, RowsAtCompileTime, Dynamic> operator()(AllIndices, const Indices& columns) const {
  return (*this)(upTo(rows()), columns);
}

Matrix<Scalar, Dynamic, 1> operator()(const Indices& rows) const {
  EIGEN_STATIC_ASSERT_VECTOR_ONLY(Derived)
  return (*this)(rows, Indices{0});
}

Selection<Derived> operator()(const Indices& rows, const Indices& columns) {
  return {this->derived(), rows, columns};
}

Selection<Derived> operator()(const Indices& rows, AllIndices) {
  return (*this)(rows, upTo(cols()));
}

Selection<Derived> operator()(AllIndices, const Indices& columns) {
  return (*this)(upTo(rows()), columns);
}

Selection<Derived> operator()(const Indices& rows) {
  EIGEN_STATIC_ASSERT_VECTOR_ONLY(Derived)
  return (*this)(rows, Indices{0});
}

static Indices upTo(Index count) {
  Indices indices(static_cast<std::size_t>(count));
  for (std::size_t n = 0; n < indices.size(); ++n) {
    indices[n] = static_cast<Index>(n);
  }
  return indices;
}
