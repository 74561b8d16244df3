//! Lays rectangles out on shelves: rows as high as their highest rectangle, filled from the left.

/// Where rectangles lie on the texture.
#[derive(Debug, Clone, PartialEq)]
pub struct Layout {
    /// Texels, a multiple of 4.
    pub width: u32,
    /// Texels, a multiple of 4.
    pub height: u32,
    /// Left and top of each rectangle, in the order in which they came.
    pub corners: Vec<[u32; 2]>,
}

/// Shelves waste some room at their ends: the texture is made this much wider than the square of the same area.
const SLACK: f64 = 1.03;

/// Packs rectangles (width, height) into a nearly square texture with sides of at most `side_max`; `None` when they do
/// not fit. Highest first, so that a shelf holds rectangles of about one height.
pub fn pack(sizes: &[[u32; 2]], side_max: u32) -> Option<Layout> {
    let area: f64 = sizes.iter().map(|[w, h]| f64::from(*w) * f64::from(*h)).sum();
    let widest = sizes.iter().map(|s| s[0]).max().unwrap_or(0);
    let square = ((area.sqrt() * SLACK).ceil() as u32).max(widest).next_multiple_of(4);
    [square, side_max / 4 * 4].into_iter().find_map(|width| shelve(sizes, width, side_max))
}

fn shelve(sizes: &[[u32; 2]], width: u32, side_max: u32) -> Option<Layout> {
    let mut order: Vec<usize> = (0..sizes.len()).collect();
    order.sort_unstable_by_key(|&i| (std::cmp::Reverse((sizes[i][1], sizes[i][0])), i));
    let mut corners = vec![[0, 0]; sizes.len()];
    let (mut left, mut top, mut shelf_height) = (0, 0, 0);
    for i in order {
        let [w, h] = sizes[i];
        if w > width {
            return None;
        }
        if left + w > width {
            (left, top, shelf_height) = (0, top + shelf_height, 0);
        }
        corners[i] = [left, top];
        left += w;
        shelf_height = shelf_height.max(h);
        if top + shelf_height > side_max {
            return None;
        }
    }
    let height = (top + shelf_height).next_multiple_of(4);
    (width <= side_max && height <= side_max).then_some(Layout { width, height, corners })
}
