//! The substeps of a step, or of a substep: halved where much happens, and longer again after that.

/// Walks through a substep in shorter ones. Each is a half, a quarter, … of a step, so that there are
/// maps for all.
pub struct SubstepIter {
    /// Level of the whole, and of the shortest substep.
    base: usize,
    finest: usize,
    /// Level of the next substep.
    level: usize,
    /// Where it begins, in shortest substeps.
    done: u32,
}

impl SubstepIter {
    /// A whole of level `base`, as one substep so far; `finest` is the level of the shortest.
    #[inline(always)]
    pub fn new(base: usize, finest: usize) -> Self {
        SubstepIter {
            base,
            finest: finest.max(base),
            level: base,
            done: 0,
        }
    }

    /// Level of the next substep; `None` at the end.
    #[inline(always)]
    pub fn next(&self) -> Option<usize> {
        (!self.done()).then_some(self.level)
    }

    /// Whether the end is reached.
    #[inline(always)]
    pub fn done(&self) -> bool {
        self.done >= self.length(self.base)
    }

    /// Level of the next substep, where the end is not reached.
    #[inline(always)]
    pub fn level(&self) -> usize {
        self.level
    }

    /// Halves the next substep, unless it is the shortest already; returns whether it did.
    #[inline(always)]
    pub fn halve(&mut self) -> bool {
        let longer = self.level < self.finest;
        self.level += usize::from(longer);
        longer
    }

    /// Passes the substep. The next one is as long as its place allows: it begins at a multiple of its length.
    #[inline(always)]
    pub fn pass(&mut self) {
        self.done += self.length(self.level);
        let longest = self
            .finest
            .saturating_sub(self.done.trailing_zeros() as usize);
        self.level = longest.max(self.base);
    }

    /// Length of a substep, in shortest ones.
    #[inline(always)]
    fn length(&self, level: usize) -> u32 {
        1 << (self.finest - level)
    }
}
