@vertex
fn crowd_outline_main(in: CrowdIn) -> VertexOut {
    return outline_out(of_one(in));
}
