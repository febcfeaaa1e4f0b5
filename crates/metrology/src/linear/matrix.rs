//! A dense matrix.

/// A matrix, row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct Matrix {
    rows: usize,
    columns: usize,
    values: Vec<f64>,
}

impl Matrix {
    /// Zeros.
    #[must_use]
    pub fn zeros(rows: usize, columns: usize) -> Self {
        Self { rows, columns, values: vec![0.0; rows * columns] }
    }

    /// The matrix whose rows are given, each of `columns` numbers. Panics where one is longer or shorter.
    #[must_use]
    pub fn from_rows<R: AsRef<[f64]>>(columns: usize, rows: impl IntoIterator<Item = R>) -> Self {
        let mut made = Self::zeros(0, columns);
        for row in rows {
            assert_eq!(row.as_ref().len(), columns, "a row of a matrix of {columns} columns");
            made.values.extend_from_slice(row.as_ref());
            made.rows += 1;
        }
        made
    }

    /// Rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Columns.
    #[must_use]
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// The number in row `i`, column `j`.
    #[must_use]
    pub fn at(&self, i: usize, j: usize) -> f64 {
        self.values[i * self.columns + j]
    }

    /// The number in row `i`, column `j`, to be changed.
    pub fn at_mut(&mut self, i: usize, j: usize) -> &mut f64 {
        &mut self.values[i * self.columns + j]
    }

    /// Row `i`.
    #[must_use]
    pub fn row(&self, i: usize) -> &[f64] {
        &self.values[i * self.columns..][..self.columns]
    }

    /// The product with a vector.
    #[must_use]
    pub fn times(&self, v: &[f64]) -> Vec<f64> {
        (0..self.rows).map(|i| dot(self.row(i), v)).collect()
    }

    /// AᵀA.
    #[must_use]
    pub fn gram(&self) -> Self {
        let n = self.columns;
        let mut gram = Self::zeros(n, n);
        for r in 0..self.rows {
            let row = self.row(r);
            for (i, a) in row.iter().enumerate() {
                let sums = &mut gram.values[i * n..][..=i];
                sums.iter_mut().zip(row).for_each(|(sum, b)| *sum += a * b);
            }
        }
        for i in 0..n {
            for j in 0..i {
                *gram.at_mut(j, i) = gram.at(i, j);
            }
        }
        gram
    }

    /// The product with a symmetric matrix.
    #[must_use]
    pub fn times_symmetric(&self, other: &Self) -> Self {
        Self::from_rows(other.columns, (0..self.rows).map(|i| other.times(self.row(i))))
    }

    /// The same, `factor` times.
    #[must_use]
    pub fn scaled(mut self, factor: f64) -> Self {
        self.values.iter_mut().for_each(|value| *value *= factor);
        self
    }

    /// vᵀ A v.
    #[must_use]
    pub fn form(&self, v: &[f64]) -> f64 {
        dot(v, &self.times(v))
    }
}

/// The inner product.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
