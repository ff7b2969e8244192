//! What is done to checked recordings before they are lowered, whether they are fitted or diagnosed.

use crate::late_driver::cut_late_drivers;
use crate::shaft_angle::align_shaft_angles;
use servoid_io::recording::Recording;

/// Cuts the first moments of late drivers off, and counts all angles from where the first recording does; returns a remark on each change.
pub fn prepare(fitted: &mut [Recording], held_out: &mut [Recording]) -> Vec<String> {
    let mut remarks = cut_late_drivers(fitted);
    remarks.extend(cut_late_drivers(held_out));
    remarks.extend(align_shaft_angles(fitted, held_out));
    remarks
}
