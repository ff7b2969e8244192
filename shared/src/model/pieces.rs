//! A part of a step in pieces: halved where much happens, and longer again after that.

/// The pieces of a part. Each is a half, a quarter, … of it, so that there are maps for all.
pub struct Pieces {
    /// Halvings of the step that make the part, and its shortest pieces.
    base: usize,
    finest: usize,
    /// Halvings that make the next piece.
    level: usize,
    /// Where it begins, in shortest pieces.
    done: u32,
}

impl Pieces {
    /// A part that is `base` halvings of a step, in one piece as yet; `finest` halvings make the
    /// shortest.
    #[inline(always)]
    pub fn new(base: usize, finest: usize) -> Self {
        Pieces {
            base,
            finest: finest.max(base),
            level: base,
            done: 0,
        }
    }

    /// Halvings of a step that make the next piece; none if the part is done.
    #[inline(always)]
    pub fn next(&self) -> Option<usize> {
        (!self.done()).then_some(self.level)
    }

    /// Whether the part is done.
    #[inline(always)]
    pub fn done(&self) -> bool {
        self.done >= self.length(self.base)
    }

    /// Halvings of a step that make the next piece of a part that is not done.
    #[inline(always)]
    pub fn level(&self) -> usize {
        self.level
    }

    /// Halves the next piece, unless it is the shortest already; says whether it did.
    #[inline(always)]
    pub fn halve(&mut self) -> bool {
        let longer = self.level < self.finest;
        self.level += usize::from(longer);
        longer
    }

    /// Leaves the piece behind. The next is as long as the halves of halves allow.
    #[inline(always)]
    pub fn pass(&mut self) {
        self.done += self.length(self.level);
        // As long as where it begins is a multiple of its length.
        let longest = self
            .finest
            .saturating_sub(self.done.trailing_zeros() as usize);
        self.level = longest.max(self.base);
    }

    /// Length of a piece, in shortest ones.
    #[inline(always)]
    fn length(&self, level: usize) -> u32 {
        1 << (self.finest - level)
    }
}
