//! Instructions that `rp2350-emu` takes for others, as those that it takes for them (ARMv8-M reference manual, C2.4): loads with
//! acquire and stores with release, for it table branches, become the plain ones, which do the same for a core that does one thing
//! after another; in `CPS` it has the bits of PRIMASK and FAULTMASK the wrong way round; it knows no pair of floating-point
//! registers, which even a core that computes in single precision pushes and pops; and in `VSEL`, `VMAXNM` and `VMINNM` it looks for
//! the last bit of the result's register behind the condition instead of before it.

/// The instruction in the place of `words`, of which a short one is the first.
pub fn understood(words: [u16; 2]) -> [u16; 2] {
    let [first, second] = words;
    let (register, kind) = (first & 0xf, second >> 4 & 0xf);
    // CPSIE, CPSID.
    if first & 0xffe8 == 0xb660 {
        return [first & !3 | (first & 1) << 1 | first >> 1 & 1, second];
    }
    // VPUSH and VPOP of d registers: of twice as many s registers from twice the number on, which have the same fields.
    if [0xed2d, 0xecbd].contains(&first) && second & 0x0f00 == 0x0b00 {
        return [first, second & !0x0100];
    }
    // VSEL, VMAXNM, VMINNM.
    if first & 0xff00 == 0xfe00 && second & 0x0f10 == 0x0a00 {
        let (last, condition) = (first >> 6 & 1, first >> 4 & 3);
        return [first & !0x70 | condition << 5 | last << 4, second];
    }
    let stores = match first & 0xfff0 {
        0xe8c0 => true,
        0xe8d0 => false,
        _ => return words,
    };
    if second & 0x0f00 != 0x0f00 {
        return words;
    }
    let value = second & 0xf000;
    match kind {
        // LDAB, LDAH, LDA; STLB, STLH, STL: the immediate offset is zero.
        0x8..=0xa => {
            let size = (kind - 0x8) * 0x20;
            [
                0xf880 + size + if stores { 0 } else { 0x10 } + register,
                value,
            ]
        }
        // LDAEXB, LDAEXH; STLEXB, STLEXH.
        0xc | 0xd => [first, second & !0x0080],
        // LDAEX; STLEX, whose result has another place.
        0xe if stores => [0xe840 + register, value | (second & 0xf) << 8],
        0xe => [0xe850 + register, value | 0x0f00],
        _ => words,
    }
}

#[cfg(test)]
mod tests {
    use super::understood;

    #[test]
    fn what_it_takes_for_another_is_changed_and_all_others_stay() {
        // Encodings as an assembler has them: r1 is the address, r2 the value, r0 the result.
        for (meant, expected) in [
            ([0xe8d1, 0x2f8f], [0xf891, 0x2000]), // LDAB: LDRB
            ([0xe8d1, 0x2f9f], [0xf8b1, 0x2000]), // LDAH: LDRH
            ([0xe8d1, 0x2faf], [0xf8d1, 0x2000]), // LDA: LDR
            ([0xe8c1, 0x2f8f], [0xf881, 0x2000]), // STLB: STRB
            ([0xe8c1, 0x2f9f], [0xf8a1, 0x2000]), // STLH: STRH
            ([0xe8c1, 0x2faf], [0xf8c1, 0x2000]), // STL: STR
            ([0xe8d1, 0x2fcf], [0xe8d1, 0x2f4f]), // LDAEXB: LDREXB
            ([0xe8d1, 0x2fdf], [0xe8d1, 0x2f5f]), // LDAEXH: LDREXH
            ([0xe8d1, 0x2fef], [0xe851, 0x2f00]), // LDAEX: LDREX
            ([0xe8c1, 0x2fc0], [0xe8c1, 0x2f40]), // STLEXB: STREXB
            ([0xe8c1, 0x2fd0], [0xe8c1, 0x2f50]), // STLEXH: STREXH
            ([0xe8c1, 0x2fe0], [0xe841, 0x2000]), // STLEX: STREX
            ([0xb672, 0x4608], [0xb671, 0x4608]), // CPSID i
            ([0xb661, 0x4608], [0xb662, 0x4608]), // CPSIE f
            ([0xed2d, 0x8b0a], [0xed2d, 0x8a0a]), // VPUSH {d8-d12}: {s16-s25}
            ([0xecbd, 0x8b0a], [0xecbd, 0x8a0a]), // VPOP {d8-d12}
            ([0xfe30, 0x0a81], [0xfe60, 0x0a81]), // VSELGT.F32 s0, s1, s2
            ([0xfe40, 0x0a81], [0xfe10, 0x0a81]), // VSELEQ.F32 s1, s1, s2
            ([0xfec0, 0x0a81], [0xfe90, 0x0a81]), // VMAXNM.F32 s1, s1, s2
            ([0xe8d1, 0xf002], [0xe8d1, 0xf002]), // TBB
            ([0xe8d1, 0x2f4f], [0xe8d1, 0x2f4f]), // LDREXB
            ([0xe9d1, 0x2f8f], [0xe9d1, 0x2f8f]), // LDRD
            ([0x4608, 0x2f8f], [0x4608, 0x2f8f]), // MOV
        ] {
            assert_eq!(understood(meant), expected, "{meant:x?}");
        }
    }
}
