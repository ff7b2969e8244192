//! MATLAB's files of level 5.

mod expected;

#[test]
fn variables_are_what_scipy_wrote() {
    expected::hold("matlab");
}
