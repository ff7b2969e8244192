//! JSON, JSON lines and WPILib's SysId.

mod expected;

#[test]
fn values_are_what_python_wrote() {
    expected::hold("json");
}
