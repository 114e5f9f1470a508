@vertex
fn crowd_standard_main(in: CrowdIn) -> StandardOut {
    return standard_out(of_one(in), NO_EXTRA);
}

@vertex
fn crowd_standard_extra_main(in: CrowdIn, extra: ExtraIn) -> StandardOut {
    return standard_out(of_one(in), extra);
}
