@vertex
fn crowd_part_outline_main(in: CrowdIn) -> StandardOut {
    return pushed(of_one(in), NO_EXTRA);
}

@vertex
fn crowd_part_outline_extra_main(in: CrowdIn, extra: ExtraIn) -> StandardOut {
    return pushed(of_one(in), extra);
}
