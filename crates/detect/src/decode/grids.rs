/// Strides of the grids of nearly all of these networks: pixels of the input to a cell, the finest first.
pub(super) const USUAL_STRIDES: &[usize] = &[8, 16, 32];

/// Strides of the grids that these networks come with: the usual ones, those of the P6 and P2 variants of `YOLOv5` and
/// `YOLOv8`, and those of the tiny ones.
pub(super) const GRIDS: [&[usize]; 4] =
    [USUAL_STRIDES, &[8, 16, 32, 64], &[4, 8, 16, 32], &[16, 32]];

/// Whether the grids of these strides, or of any usual ones, have so many times as many cells as there are rows.
pub(super) fn on_usual_grid(
    rows: usize,
    times: usize,
    input: [usize; 2],
    strides: Option<&[usize]>,
) -> bool {
    let fits = |strides: &[usize]| times * cells(input, strides) == rows;
    strides.map_or_else(|| GRIDS.iter().any(|grid| fits(grid)), fits)
}

/// How many cells the grids of these strides have together on an input of `[width, height]` pixels.
pub(super) fn cells(input: [usize; 2], strides: &[usize]) -> usize {
    let grid = |stride: &usize| input[0].div_ceil(*stride) * input[1].div_ceil(*stride);
    strides.iter().map(grid).sum()
}
